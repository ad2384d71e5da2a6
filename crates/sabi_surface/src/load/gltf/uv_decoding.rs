//! Chooses the transforms with which stored texture coordinates are decoded.
//!
//! Quantizers store UVs as integers, often with 12 of 16 bits, and write the inverse transform as KHR_texture_transform at every texture
//! of the material. The artist's layout is the transformed one. The same extension is also used to tile textures, and in that case the
//! stored coordinates are the layout. The two cases are distinguished by integers, and by a stored layout that would otherwise be tiny. If
//! the artist rotated or mirrored a texture, the quantizer multiplies both into one transform. Another texture of the material may have
//! the inverse transform alone, also on another UV set, since quantizers store all sets of a material in the same way.

use std::collections::BTreeMap;

use super::primitive::LoadedPrimitive;
use super::source::GltfSource;
use super::texture_use::{TextureUse, all_texture_uses};
use crate::model::UvDecoding;

/// Minimum area, as a share of the unit square, of the bounding box of an ordinary layout.
const LEAST_AREA: f32 = 1.0 / 64.0;
/// Maximum distance of a layout outside of the unit square that counts as rounding: a step of 12-bit coordinates.
const ROUNDED: f32 = 1.0 / 4096.0;

/// The transforms of the chosen UV set by material of the file.
#[derive(Debug, Default)]
pub(super) struct UvDecodings {
    by_material: BTreeMap<usize, UvDecoding>,
}

/// Stored coordinates of all primitives of a material.
#[derive(Clone, Copy)]
struct StoredRange {
    are_integers: bool,
    low: [f32; 2],
    high: [f32; 2],
}

impl UvDecodings {
    /// Chooses a transform for each material whose primitives need one.
    pub(super) fn of_primitives<'a>(
        source: &GltfSource,
        primitives: impl Iterator<Item = &'a LoadedPrimitive>,
    ) -> UvDecodings {
        let mut stored: BTreeMap<usize, StoredRange> = BTreeMap::new();
        for primitive in primitives.filter(|primitive| !primitive.submesh.uvs.is_empty()) {
            let Some(material) = primitive.material else { continue };
            let all = stored.entry(material).or_insert(StoredRange {
                are_integers: true,
                low: [f32::INFINITY; 2],
                high: [f32::NEG_INFINITY; 2],
            });
            all.are_integers &= primitive.has_integer_uvs;
            for uv in &primitive.submesh.uvs {
                all.low = [0, 1].map(|axis| all.low[axis].min(uv[axis]));
                all.high = [0, 1].map(|axis| all.high[axis].max(uv[axis]));
            }
        }
        let chosen = stored.into_iter().filter_map(|(index, stored)| {
            let material = source.document.materials.get(index)?;
            Some((index, stored.decoding(&all_texture_uses(material), source.uv_set)?))
        });
        UvDecodings {
            by_material: chosen.collect(),
        }
    }

    /// The transform of a material of the file.
    pub(super) fn of(&self, material: Option<usize>) -> Option<UvDecoding> {
        self.by_material.get(&material?).copied()
    }

    /// Decodes the coordinates of a primitive. Its tangents stay unchanged, since a positive scale along u and v does not
    /// change their directions.
    pub(super) fn apply(&self, primitive: &mut LoadedPrimitive) {
        if let Some(decoding) = self.of(primitive.material) {
            let uvs = &mut primitive.submesh.uvs;
            uvs.iter_mut().for_each(|uv| *uv = decoding.decode(*uv));
        }
    }
}

impl StoredRange {
    /// Returns the decoding according to the textures of the material, which are listed in order of precedence; `None` if
    /// the stored coordinates are the layout.
    fn decoding(&self, uses: &[TextureUse], uv_set: u32) -> Option<UvDecoding> {
        let identity = UvDecoding {
            scale: [1.0; 2],
            offset: [0.0; 2],
        };
        let (on_set, others): (Vec<&TextureUse>, Vec<&TextureUse>) =
            uses.iter().partition(|used| used.uv_set == uv_set);
        let plain = |uses: &[&TextureUse]| -> Vec<UvDecoding> {
            let decodings = uses.iter().filter_map(|used| scale_and_offset(used.transform));
            decodings.filter(|decoding| *decoding != identity).collect()
        };
        let is_tiny = self.area(&identity) < LEAST_AREA;
        let is_layout = |decoding: &&UvDecoding| self.is_inside(decoding) && self.area(decoding) >= LEAST_AREA;
        let mut decodings = plain(&on_set);
        let fitting = decodings.iter().find(is_layout).copied();
        // Fractions within the unit square already are a layout; transforms of such textures tile them.
        let is_ordinary = self.is_inside(&identity) && !is_tiny;
        match (self.are_integers, fitting) {
            (true, Some(fitting)) => return Some(fitting),
            (true, None) if !is_ordinary => {}
            (true, None) => return None,
            (false, fitting) => return fitting.filter(|_| is_tiny),
        }
        decodings.extend(plain(&others));
        let all = on_set.iter().chain(&others);
        decodings.extend(all.filter_map(|used| unturned(used.transform)));
        let fitting = decodings.iter().find(is_layout);
        fitting.or(decodings.first()).copied()
    }

    /// Area of the box of the decoded coordinates, as a share of the unit square.
    fn area(&self, decoding: &UvDecoding) -> f32 {
        let [low, high] = [self.low, self.high].map(|corner| decoding.decode(corner));
        (high[0] - low[0]) * (high[1] - low[1])
    }

    /// Returns true if the decoded coordinates lie in the unit square.
    fn is_inside(&self, decoding: &UvDecoding) -> bool {
        let inside = -ROUNDED..=1.0 + ROUNDED;
        let corners = [self.low, self.high].map(|corner| decoding.decode(corner));
        corners.as_flattened().iter().all(|at| inside.contains(at))
    }
}

/// Returns a matrix without rotation, shear and mirroring as scale and offset. Quantizers write only such matrices.
fn scale_and_offset([[scale_u, by_v, offset_u], [by_u, scale_v, offset_v]]: [[f32; 3]; 2]) -> Option<UvDecoding> {
    let is_plain = by_v == 0.0 && by_u == 0.0 && scale_u > 0.0 && scale_v > 0.0;
    is_plain.then_some(UvDecoding {
        scale: [scale_u, scale_v],
        offset: [offset_u, offset_v],
    })
}

/// Returns the scale of a matrix that rotates or mirrors: the lengths of its columns, since it scales first. The offset is
/// dropped, since the artist's part of it is unknown. `None` if the matrix neither rotates nor mirrors.
fn unturned(rows: [[f32; 3]; 2]) -> Option<UvDecoding> {
    let [[u_by_u, u_by_v, _], [v_by_u, v_by_v, _]] = rows;
    let scale = [u_by_u.hypot(v_by_u), u_by_v.hypot(v_by_v)];
    let is_whole = scale.iter().all(|scale| scale.is_finite() && *scale > 0.0);
    (is_whole && scale_and_offset(rows).is_none()).then_some(UvDecoding {
        scale,
        offset: [0.0; 2],
    })
}
