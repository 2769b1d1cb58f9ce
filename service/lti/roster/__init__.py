"""The roster of a course at its platform (Names and Role Provisioning Services)."""
