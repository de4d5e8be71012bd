"""Reports: pages of HTML that need neither a server nor a network."""
