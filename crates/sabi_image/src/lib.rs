//! Pictures in and out: PNG, EXR, HDR, color spaces, dithering.
