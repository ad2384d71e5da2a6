//! A session: open, edit, evaluate, preview, bake.
