//! What is under the pointer.
