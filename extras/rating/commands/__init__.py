"""thermoscope use rate, thermoscope use optimise"""
