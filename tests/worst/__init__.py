"""Search for the costliest requests, as an attacker with access to the code could."""
