"""One vocabulary of a library: words, the clusters they are joined to, numbers that last."""
