"""Self-contained HTML pages of audits."""
