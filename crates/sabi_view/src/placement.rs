//! Placement of a model in view space: centered, with a largest side of 1.

use glam::{DVec3, Vec3};
use sabi_surface::model::Mesh;

/// Transform between model space and view space: `view = (model − center) × scale`.
///
/// It is applied in double precision, so that models of any size and far from their origin keep their precision. Vertices
/// are transformed once and uploaded in view space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Middle of the model's box, model units.
    pub center: [f64; 3],
    /// View units per model unit. It is finite and above 0.
    pub scale: f64,
}

impl Placement {
    /// Places a mesh by the box of the vertices that its triangles use. A mesh without extent keeps its size.
    pub fn of(mesh: &Mesh) -> Placement {
        let Some([low, high]) = bounds(mesh) else {
            return Placement {
                center: [0.0; 3],
                scale: 1.0,
            };
        };
        let side = (high - low).max_element();
        Placement {
            center: ((low + high) * 0.5).to_array(),
            scale: if side > 0.0 { side.recip() } else { 1.0 },
        }
    }

    /// Transforms a point from model space to view space.
    pub fn view_from_model(&self, position: impl Into<Vec3>) -> Vec3 {
        ((position.into().as_dvec3() - DVec3::from(self.center)) * self.scale).as_vec3()
    }

    /// Transforms a point from view space to model space.
    pub fn model_from_view(&self, position: impl Into<Vec3>) -> Vec3 {
        (position.into().as_dvec3() / self.scale + DVec3::from(self.center)).as_vec3()
    }

    /// Returns the finite vertices that triangles of a mesh use, in view space, some of them more than once.
    pub fn points_in_view(&self, mesh: &Mesh) -> Vec<Vec3> {
        let used = mesh.triangles.iter().flatten();
        let places = used.filter_map(|&vertex| mesh.positions.get(vertex as usize));
        let places = places.map(|place| self.view_from_model(*place));
        places.filter(|place| place.is_finite()).collect()
    }

    /// Returns the lowest and the highest corner of a mesh's box in view space; a single point for a mesh without finite vertices.
    pub fn box_in_view(&self, mesh: &Mesh) -> [Vec3; 2] {
        let [low, high] = bounds(mesh).unwrap_or([DVec3::from(self.center); 2]);
        [low, high].map(|corner| ((corner - DVec3::from(self.center)) * self.scale).as_vec3())
    }
}

/// Returns the lowest and the highest corner of the box of all used vertices in model units.
fn bounds(mesh: &Mesh) -> Option<[DVec3; 2]> {
    let used = mesh.triangles.iter().flatten();
    let places = used.filter_map(|&vertex| mesh.positions.get(vertex as usize));
    let finite = places
        .map(|place| Vec3::from(*place).as_dvec3())
        .filter(|place| place.is_finite());
    finite.fold(None, |bounds, place| {
        let [low, high] = bounds.unwrap_or([place; 2]);
        Some([low.min(place), high.max(place)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(corners: [[f32; 3]; 3]) -> Mesh {
        Mesh {
            positions: corners.to_vec(),
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        }
    }

    #[test]
    fn a_model_of_any_size_at_any_position_is_centered_with_a_largest_side_of_1() {
        for scale in [1e-30, 1e-6, 1.0, 1e6, 1e37] {
            let mesh = triangle([[0.0, 0.0, 0.0], [2.0 * scale, 0.0, 0.0], [0.0, scale, scale]]);
            let [low, high] = Placement::of(&mesh).box_in_view(&mesh);
            let half = Vec3::new(0.5, 0.25, 0.25);
            assert!(low.abs_diff_eq(-half, 1e-6) && high.abs_diff_eq(half, 1e-6), "{scale}");
        }
        let far = triangle([[1e6, 0.0, 0.0], [1e6 + 1.0, 0.0, 0.0], [1e6, 0.5, 0.0]]);
        let placement = Placement::of(&far);
        assert_eq!(
            placement.view_from_model(far.positions[1]),
            Vec3::new(0.5, -0.25, 0.0),
            "the difference of large numbers is exact"
        );
        assert_eq!(
            placement.model_from_view([0.5, -0.25, 0.0]),
            Vec3::from(far.positions[1])
        );
    }

    #[test]
    fn only_vertices_that_a_triangle_uses_count() {
        let mut mesh = triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let placement = Placement::of(&mesh);
        mesh.positions.push([900.0; 3]);
        assert_eq!(Placement::of(&mesh), placement);
    }

    #[test]
    fn a_model_without_extent_keeps_its_size() {
        for mesh in [Mesh::default(), triangle([[3.0; 3]; 3]), triangle([[f32::NAN; 3]; 3])] {
            let placement = Placement::of(&mesh);
            assert_eq!(placement.scale, 1.0);
            assert_eq!(placement.box_in_view(&mesh), [Vec3::ZERO; 2]);
        }
    }
}
