"""The minimum principle: from a motion and a cost to necessary conditions."""
