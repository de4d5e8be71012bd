"""General helpers that any package of kineme may import; they do not depend on recordings."""
