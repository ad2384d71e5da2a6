//! The device: textures, pipelines, running a plan, readback.
