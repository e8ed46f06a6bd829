"""Effects of the friction of joints."""
