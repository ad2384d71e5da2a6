//! Where the eye is: orbit, pan, zoom and focus.
