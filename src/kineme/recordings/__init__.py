"""What is read from a file and segmented: the motion of a body, or signals."""
