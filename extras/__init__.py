"""What stands around the diagnosis. Each uses `import thermoscope as ts` and `thermoscope.plugin` alone."""
