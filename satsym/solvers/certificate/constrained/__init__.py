"""The certificate of extremals with arcs on boundaries of path constraints."""
