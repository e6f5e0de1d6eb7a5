"""What terminal, page and typeset report of an audit share: findings by weight, the summary, objects for JSON."""
