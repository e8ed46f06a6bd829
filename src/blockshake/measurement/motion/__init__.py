"""From readings to the motion of the base, the blocks and the joints."""
