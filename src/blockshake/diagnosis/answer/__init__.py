"""All causes side by side, and the answer that the readings give."""
