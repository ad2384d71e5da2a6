//! Materials whose maps are in several UDIM tiles. A glTF material has one image for each map, so in a copy each tile has a
//! separate material, and its UVs are moved into the unit square.

use std::collections::{BTreeMap, BTreeSet};

use sabi_surface::model::Mesh;

use crate::SetKey;

/// Maximum part of a tile by which a triangle may extend into the next one without a warning.
const OVERREACH: f32 = 0.01;

/// Tiles of the baked materials that have several.
#[derive(Debug, Default)]
pub(super) struct MaterialTiles {
    /// Sets by material, UDIM numbers rising.
    by_material: BTreeMap<u32, Vec<SetKey>>,
}

impl MaterialTiles {
    /// Tiles of the baked sets.
    pub(super) fn of(baked: &BTreeSet<SetKey>) -> MaterialTiles {
        let mut by_material: BTreeMap<u32, Vec<SetKey>> = BTreeMap::new();
        for key in baked.iter().filter(|key| key.udim.is_some()) {
            by_material.entry(key.material).or_default().push(*key);
        }
        for keys in by_material.values_mut() {
            keys.sort_by_key(|key| key.udim);
        }
        MaterialTiles { by_material }
    }

    /// Returns true if a material has a set for each of several tiles.
    pub(super) fn has(&self, material: u32) -> bool {
        self.by_material.contains_key(&material)
    }

    /// Returns true for the set that takes the place of its material.
    pub(super) fn is_first(&self, key: &SetKey) -> bool {
        let keys = self.by_material.get(&key.material);
        keys.is_none_or(|keys| keys.first() == Some(key))
    }

    /// Sets besides the first one of each material.
    pub(super) fn further(&self) -> impl Iterator<Item = &SetKey> {
        self.by_material.values().flat_map(|keys| keys.iter().skip(1))
    }

    /// Set of a triangle of one of the materials: the tile of its middle, or the nearest one that has maps.
    pub(super) fn of_triangle(&self, mesh: &Mesh, triangle: usize) -> Option<SetKey> {
        let keys = self.by_material.get(mesh.triangle_material.get(triangle)?)?;
        let corners = uvs(mesh, triangle)?;
        let middle = [0, 1].map(|axis| corners.map(|uv| uv[axis]).iter().sum::<f32>() / 3.0);
        let distance = |key: &SetKey| -> f32 {
            let tile = key.uv_tile.map(|tile| tile as f32);
            let outside = |axis: usize| {
                (tile[axis] - middle[axis])
                    .max(middle[axis] - tile[axis] - 1.0)
                    .max(0.0)
            };
            outside(0).hypot(outside(1))
        };
        // A middle on the border of two tiles belongs to the tile that starts there.
        let rank = |key: &SetKey| {
            (
                distance(key),
                middle.map(f32::floor) != key.uv_tile.map(|tile| tile as f32),
            )
        };
        let order = |a: &&SetKey, b: &&SetKey| {
            let ((near, is_other), (other_near, other_is_other)) = (rank(a), rank(b));
            near.total_cmp(&other_near).then(is_other.cmp(&other_is_other))
        };
        keys.iter().min_by(order).copied()
    }

    /// Returns a warning for each material with triangles that reach into the next tile; `name` names a material.
    pub(super) fn warnings(&self, mesh: &Mesh, name: &dyn Fn(u32) -> String) -> Vec<String> {
        let mut crossing: BTreeMap<u32, usize> = BTreeMap::new();
        for triangle in 0..mesh.triangles.len() {
            if let Some(key) = self.of_triangle(mesh, triangle)
                && uvs(mesh, triangle).is_some_and(|corners| reaches_over(corners, key))
            {
                *crossing.entry(key.material).or_default() += 1;
            }
        }
        let sentence = |(material, triangles): (u32, usize)| {
            let reach = match triangles {
                1 => "1 triangle reaches".to_owned(),
                several => format!("{several} triangles reach"),
            };
            format!(
                "the copy of the model has a material for each UDIM tile of '{}', and {reach} over the border of a tile: the copy \
                 shows the edge of the picture there; cut the UVs at the borders of the tiles",
                name(material)
            )
        };
        crossing.into_iter().map(sentence).collect()
    }
}

/// Coordinates in the unit square of a tile.
pub(super) fn in_tile(uv: [f32; 2], tile: [i32; 2]) -> [f32; 2] {
    [0, 1].map(|axis| uv[axis] - tile[axis] as f32)
}

fn uvs(mesh: &Mesh, triangle: usize) -> Option<[[f32; 2]; 3]> {
    let [a, b, c] = mesh
        .triangles
        .get(triangle)?
        .map(|vertex| mesh.uvs.get(vertex as usize));
    Some([*a?, *b?, *c?])
}

fn reaches_over(corners: [[f32; 2]; 3], key: SetKey) -> bool {
    let inside = |at: &f32| (-OVERREACH..=1.0 + OVERREACH).contains(at);
    corners.iter().any(|uv| !in_tile(*uv, key.uv_tile).iter().all(inside))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(uv_tile: [i32; 2], udim: u32) -> SetKey {
        SetKey {
            material: 0,
            uv_tile,
            udim: Some(udim),
        }
    }

    fn mesh(uvs: [[f32; 2]; 3]) -> Mesh {
        Mesh {
            positions: vec![[0.0; 3]; 3],
            uvs: uvs.to_vec(),
            triangles: vec![[0, 1, 2]],
            triangle_material: vec![0],
            ..Mesh::default()
        }
    }

    #[test]
    fn a_triangle_belongs_to_the_tile_of_its_middle_or_the_nearest_one_with_maps() {
        let tiles = MaterialTiles::of(&BTreeSet::from([
            key([0, -1], 1011),
            key([1, 0], 1002),
            key([0, 0], 1001),
        ]));
        let cases: [([[f32; 2]; 3], u32, usize); 6] = [
            ([[0.1, 0.1], [0.9, 0.1], [0.1, 0.9]], 1001, 0),
            ([[1.0, 0.0], [2.0, 0.0], [1.0, 1.0]], 1002, 0),
            ([[0.5, -0.5], [0.6, -0.5], [0.5, -0.4]], 1011, 0),
            ([[0.5, 0.5], [1.2, 0.5], [0.5, 0.6]], 1001, 1),
            ([[3.1, 0.5], [3.2, 0.5], [3.1, 0.6]], 1002, 1),
            ([[1.0, 0.5], [1.0, 0.5], [1.0, 0.5]], 1002, 0),
        ];
        for (uvs, udim, crossing) in cases {
            let mesh = mesh(uvs);
            let found = tiles.of_triangle(&mesh, 0).unwrap();
            assert_eq!(found.udim, Some(udim), "{uvs:?}");
            let warnings = tiles.warnings(&mesh, &|_| "wood".to_owned());
            assert_eq!(warnings.len(), crossing, "{uvs:?}");
            let sentence = "the copy of the model has a material for each UDIM tile of 'wood', and 1 triangle reaches over the \
                            border of a tile: the copy shows the edge of the picture there; cut the UVs at the borders of the \
                            tiles";
            assert!(warnings.iter().all(|warning| warning == sentence), "{warnings:?}");
        }
        assert!(MaterialTiles::default().of_triangle(&mesh([[0.0; 2]; 3]), 0).is_none());
    }
}
