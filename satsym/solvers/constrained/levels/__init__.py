"""Path constraints where H is linear in the controls: levels at bounds, singular ones, and boundaries."""
