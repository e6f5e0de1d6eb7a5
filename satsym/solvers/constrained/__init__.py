"""Path constraints on states and controls: sequences of boundary arcs and touch points, and exact arcs."""
