"""Random samples of joint values and link parameters, and the comparison of numbers at them."""
