"""The slips in the robot's table, or in its joints, that spoil a later answer."""
