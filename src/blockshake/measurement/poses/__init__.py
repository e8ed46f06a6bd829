"""Tests of one body over a level ground, filmed as poses: no marker, no motion of the ground."""
