//! Texture sets and the files beside them.
