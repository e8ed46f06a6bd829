"""Pages: blocks of a document, pictures, words and units, and how they become HTML and PDF."""
