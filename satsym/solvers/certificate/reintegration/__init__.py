"""A solution integrated anew: its flow from the start, or segment by segment where that grows, and its defects."""
