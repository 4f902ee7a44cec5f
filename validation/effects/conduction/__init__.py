"""Heat that leaves or crosses by conduction, and heat capacity."""
