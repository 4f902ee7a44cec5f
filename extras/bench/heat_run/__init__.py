"""The heat run: rise by method against the limit of its thermal class, and the page that says so."""
