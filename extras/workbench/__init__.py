"""The workbench: a case in the browser. A page per tab, calculations in processes of their own."""
