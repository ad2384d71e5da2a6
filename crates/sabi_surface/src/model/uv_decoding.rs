//! Texture coordinates that the file stores with a transform.

/// Transform from stored to actual texture coordinates, as written by quantizers: `uv = stored × scale + offset`. In glTF
/// it is stored as KHR_texture_transform at each texture of the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvDecoding {
    /// Factor of u and v, above 0.
    pub scale: [f32; 2],
    /// Offset of u and v.
    pub offset: [f32; 2],
}

impl UvDecoding {
    /// Decodes a stored coordinate.
    pub fn decode(&self, stored: [f32; 2]) -> [f32; 2] {
        std::array::from_fn(|axis| stored[axis] * self.scale[axis] + self.offset[axis])
    }

    /// Its matrix, rows, as [`super::TextureRef::transform`].
    pub fn rows(&self) -> [[f32; 3]; 2] {
        let ([scale_u, scale_v], [offset_u, offset_v]) = (self.scale, self.offset);
        [[scale_u, 0.0, offset_u], [0.0, scale_v, offset_v]]
    }

    /// Returns the transform that has the same effect on decoded coordinates as `transform` has on stored ones.
    pub(crate) fn undone(&self, transform: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
        // Inverting the matrix would leave rounding errors.
        if transform == self.rows() {
            return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        }
        transform.map(|[by_u, by_v, offset]| {
            let (by_u, by_v) = (by_u / self.scale[0], by_v / self.scale[1]);
            [by_u, by_v, offset - by_u * self.offset[0] - by_v * self.offset[1]]
        })
    }
}
