"""The forward-backward sweep: by relaxation as textbooks have it, and by quasi-Newton steps."""
