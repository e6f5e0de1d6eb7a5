"""The forward-backward sweep method: by relaxation as in textbooks, and by quasi-Newton steps."""
