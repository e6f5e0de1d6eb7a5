"""Commands about models, instances, results and documents, one file each."""
