"""What people look at without a server: one page of HTML that holds everything."""
