"""Common parts of audit reports on terminals, pages and paper: findings by weight, summaries, objects for JSON."""
