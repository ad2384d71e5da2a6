//! Maps of the model itself, which need no node in the graph.

use strum::VariantArray;

/// Map of the model itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, VariantArray)]
pub enum MeshMap {
    /// A color for each part, to select parts by.
    Id,
    /// A color for each material.
    MaterialId,
    /// Normals in model space, components in −1..1.
    WorldNormal,
    /// Place in the model's bounding box, 0..1 along each axis.
    Position,
    /// The most open direction in model space, components in −1..1.
    BentNormal,
    /// 1 open, 0 buried.
    AmbientOcclusion,
    /// Mean depth below the surface, 0 thin to 1.
    Thickness,
    /// Bend of the surface, −1 concave to 1 convex.
    Curvature,
}

impl MeshMap {
    /// All maps, in the order in which they are written.
    pub const ALL: &'static [MeshMap] = MeshMap::VARIANTS;

    /// Name in preset files, in reports and in file names.
    pub fn name(self) -> &'static str {
        match self {
            MeshMap::Id => "id",
            MeshMap::MaterialId => "material_id",
            MeshMap::WorldNormal => "world_normal",
            MeshMap::Position => "position",
            MeshMap::BentNormal => "bent_normal",
            MeshMap::AmbientOcclusion => "ambient_occlusion",
            MeshMap::Thickness => "thickness",
            MeshMap::Curvature => "curvature",
        }
    }

    /// Returns the map of a name; an error lists all.
    pub fn of_name(name: &str) -> Result<MeshMap, String> {
        let found = MeshMap::ALL.iter().copied().find(|map| map.name() == name);
        found.ok_or_else(|| {
            let known = MeshMap::ALL.iter().map(|map| map.name()).collect::<Vec<_>>().join(", ");
            format!("there is no map `{name}` of the model; there is: {known}")
        })
    }

    /// Returns a pixel's value where nothing is known: in a color, three.
    pub(crate) fn neutral(self) -> &'static [f32] {
        match self {
            MeshMap::AmbientOcclusion => &[1.0],
            MeshMap::Thickness | MeshMap::Curvature => &[0.0],
            MeshMap::Id | MeshMap::MaterialId | MeshMap::WorldNormal | MeshMap::Position | MeshMap::BentNormal => {
                &[0.0; 3]
            }
        }
    }

    /// True for colors, which are written in sRGB.
    pub(crate) fn is_color(self) -> bool {
        matches!(self, MeshMap::Id | MeshMap::MaterialId)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_known_by_its_name() {
        for &map in MeshMap::ALL {
            assert_eq!(MeshMap::of_name(map.name()), Ok(map));
        }
        let told = MeshMap::of_name("ao").unwrap_err();
        let why = "there is no map `ao` of the model; there is: id, material_id, world_normal, position, bent_normal, \
                   ambient_occlusion, thickness, curvature";
        assert_eq!(told, why);
    }
}
