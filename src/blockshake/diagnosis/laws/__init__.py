"""Laws of the joints: which ones a test breaks, and which effect breaks just these."""
