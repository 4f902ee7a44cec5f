"""thermoscope use export"""
