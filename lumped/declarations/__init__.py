"""Networks declared by hand: network.toml, table by table."""
