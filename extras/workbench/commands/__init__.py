"""thermoscope show serve"""
