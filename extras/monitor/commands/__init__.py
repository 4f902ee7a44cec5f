"""thermoscope use watch, thermoscope use fleet"""
