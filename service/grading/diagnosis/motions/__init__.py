"""The slips in a product of transforms or motions."""
