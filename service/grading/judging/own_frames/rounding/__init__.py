"""Find the exact numbers of tables with rounded decimals."""
