//! Pictures of a model, pixel by pixel: light, maps, relief and shadows.

mod agreement;
mod bloom;
mod borders;
mod clay;
mod default_look;
mod extents;
mod finishes;
mod furnace;
mod poses;
mod relief;
mod sharing;
mod sizes;
mod sun;
mod viewport;

use glam::{UVec2, Vec2};
use sabi_tests::DrawableGraph;
use sabi_view::{Camera, PickedPoint, aspect_of, pick};

/// Each pixel of a picture whose middle sees the model, with the surface point there.
fn seen<'p>(
    pictured: &'p DrawableGraph,
    camera: &'p Camera,
    [width, height]: [u32; 2],
) -> impl Iterator<Item = (usize, PickedPoint)> + 'p {
    let size = UVec2::new(width, height).as_vec2();
    let linked = pictured.on_mesh.evaluator.linked();
    let mesh = &linked.model.mesh;
    let bvh = linked.bvh.get_or_init(|| sabi_surface::bvh::Bvh::build(mesh));
    (0..(width * height) as usize).filter_map(move |pixel| {
        let at = Vec2::new((pixel as u32 % width) as f32 + 0.5, (pixel as u32 / width) as f32 + 0.5);
        let ray = camera.ray(at / size, aspect_of(size));
        let picked = pick(bvh, mesh, &linked.atlas, ray, &pictured.model.placement)?;
        Some((pixel, picked))
    })
}

/// Returns true if a place is well inside its triangle, with all four texels around it on the chart itself: beside a
/// seam, values are read from ghosts, which are compared elsewhere.
fn is_inside(picked: &PickedPoint) -> bool {
    picked.barycentric.iter().all(|share| *share > 0.05)
}
