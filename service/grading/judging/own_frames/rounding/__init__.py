"""Tables with rounded decimals."""
