//! What a specular lobe reflects of a white surrounding, as a table.
