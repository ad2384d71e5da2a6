//! A graph and its kinds become a list of passes: plain data that prints and compares.
