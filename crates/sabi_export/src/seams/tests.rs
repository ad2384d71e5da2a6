//! Seam erasure on two faces whose charts differ in position, rotation and density.

use sabi_surface::atlas::{Atlas, AtlasOptions};
use sabi_surface::model::Mesh;
use sabi_surface::seams::seams;

use super::SeamSamples;
use crate::layout::{Cover, NONE, SetLayout, layouts};
use crate::{ChannelPixels, Padding, PaddingMap};

const SIZE: u32 = 64;

/// A face of the model: four corners, counter-clockwise, its normal, and the corners' places in texels.
struct Face {
    corners: [[f32; 3]; 4],
    normal: [f32; 3],
    texels: [[f32; 2]; 4],
}

/// A square left of the edge from (0, 0, 0) to (0, 1, 0), straight on the map.
fn left() -> Face {
    Face {
        corners: [[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
        normal: [0.0, 0.0, 1.0],
        texels: [[4.3, 28.6], [24.3, 28.6], [24.3, 8.6], [4.3, 8.6]],
    }
}

/// Corners of a chart that is rotated and of another density.
const TURNED: [[f32; 2]; 4] = [[40.2, 20.4], [56.2, 32.4], [44.2, 48.4], [28.2, 36.4]];

/// The square on its right, level with it.
fn right() -> Face {
    Face {
        corners: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        normal: [0.0, 0.0, 1.0],
        texels: TURNED,
    }
}

/// The square that goes down from the edge.
fn down() -> Face {
    Face {
        corners: [[0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 0.0]],
        normal: [1.0, 0.0, 0.0],
        texels: TURNED,
    }
}

fn mesh(faces: &[Face]) -> Mesh {
    let mut mesh = Mesh::default();
    for face in faces {
        let first = mesh.positions.len() as u32;
        mesh.triangles
            .extend([[0, 1, 2], [0, 2, 3]].map(|corners: [u32; 3]| corners.map(|corner| first + corner)));
        mesh.positions.extend(face.corners);
        mesh.normals.extend([face.normal; 4]);
        mesh.uvs
            .extend(face.texels.map(|place| place.map(|value| value / SIZE as f32)));
        // Along u: the inverse of the affine map from the surface to the map.
        let side = |from: usize, to: usize| -> ([f32; 3], [f32; 2]) {
            (
                std::array::from_fn(|at| face.corners[to][at] - face.corners[from][at]),
                std::array::from_fn(|at| face.texels[to][at] - face.texels[from][at]),
            )
        };
        let ((along, [a, b]), (up, [c, d])) = (side(0, 1), side(0, 3));
        let area = a * d - b * c;
        let tangent: [f32; 3] = std::array::from_fn(|at| (along[at] * d - up[at] * b) / area);
        let length = tangent.iter().map(|value| value * value).sum::<f32>().sqrt();
        let [x, y, z] = tangent.map(|value| value / length);
        mesh.tangents.extend([[x, y, z, 1.0]; 4]);
    }
    mesh.triangle_material = vec![0; mesh.triangles.len()];
    mesh.triangle_part = vec![0; mesh.triangles.len()];
    mesh
}

struct Fixture {
    mesh: Mesh,
    layout: SetLayout,
    samples: SeamSamples,
    /// For each pixel the face whose chart it shows.
    face: Vec<Option<u32>>,
}

fn fixture(faces: &[Face]) -> Fixture {
    let mesh = mesh(faces);
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(SIZE)).unwrap();
    let layout = layouts(&atlas).remove(0);
    let samples = SeamSamples::new(&mesh, &seams(&mesh, &atlas), &atlas, &layout);
    let [width, height] = atlas.page_size;
    let chart = |texel: u32| {
        let (page, y, x) = (texel / width / height, texel / width % height, texel % width);
        match atlas.owner(x, y, page) {
            sabi_surface::atlas::Owner::Triangle(triangle) => atlas.triangle_chart[triangle as usize],
            sabi_surface::atlas::Owner::Ghost(ghost) => atlas.ghosts[ghost as usize].chart,
            sabi_surface::atlas::Owner::Empty => panic!("a source is not empty"),
        }
    };
    let face = layout
        .source
        .iter()
        .map(|&texel| (texel != NONE).then(|| chart(texel)))
        .collect();
    Fixture {
        mesh,
        layout,
        samples,
        face,
    }
}

impl Fixture {
    /// Pixels with these values on the charts of the faces, and others elsewhere.
    fn pixels<const N: usize>(&self, of_face: &[[f32; N]], elsewhere: [f32; N]) -> ChannelPixels {
        let value = |face: &Option<u32>| face.map_or(elsewhere, |face| of_face[face as usize]);
        ChannelPixels {
            components: N,
            data: self.face.iter().flat_map(value).collect(),
        }
    }

    /// Computes the distance from a pixel's center to the edge between the faces on the nearer chart, in texels.
    fn away(&self, pixel: usize) -> f32 {
        let place = [pixel % SIZE as usize, pixel / SIZE as usize].map(|value| value as f32 + 0.5);
        let edge = |[from, to]: [[f32; 2]; 2]| {
            let along: [f32; 2] = [to[0] - from[0], to[1] - from[1]];
            let step = [place[0] - from[0], place[1] - from[1]];
            let share = (along[0] * step[0] + along[1] * step[1]) / (along[0] * along[0] + along[1] * along[1]);
            let share = share.clamp(0.0, 1.0);
            (step[0] - share * along[0]).hypot(step[1] - share * along[1])
        };
        let left = left().texels;
        edge([left[1], left[2]]).min(edge([TURNED[0], TURNED[3]]))
    }
}

/// A unit vector in space as the tangent-space normal of a face.
fn stored(mesh: &Mesh, vertex: usize, normal: [f32; 3]) -> [f32; 3] {
    let ([tx, ty, tz, sign], [nx, ny, nz]) = (mesh.tangents[vertex], mesh.normals[vertex]);
    let bitangent = [ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx].map(|value| sign * value);
    [[tx, ty, tz], bitangent, [nx, ny, nz]].map(|axis| (0..3).map(|at| axis[at] * normal[at]).sum())
}

#[test]
fn a_step_of_one_over_a_seam_is_gone_and_texels_away_from_it_keep_their_bits() {
    let fixture = fixture(&[left(), right()]);
    let before = fixture.pixels(&[[0.0], [1.0]], [7.0]);
    assert!((fixture.samples.height_difference(&before) - 1.0).abs() < 1e-9);
    let mut after = before.clone();
    fixture.samples.erase_heights(&mut after);
    let left_over = fixture.samples.height_difference(&after);
    assert!(left_over < 0.05, "{left_over}");
    let mut changed = 0;
    for (pixel, (old, new)) in before.data.iter().zip(&after.data).enumerate() {
        if fixture.away(pixel) > 1.5 || fixture.face[pixel].is_none() {
            assert_eq!(old.to_bits(), new.to_bits(), "pixel {pixel}");
        }
        changed += usize::from(old.to_bits() != new.to_bits());
        assert!((0.0..=1.0).contains(new) || *new == 7.0, "{new}");
    }
    assert!((60..160).contains(&changed), "{changed} texels beside 20 of seam");
}

#[test]
fn waves_are_equalized_as_far_as_linear_interpolation_allows() {
    // Eight texels from crest to crest; straight lines between texels miss a crest by (kh)²/8.
    let wave = |along: f32| (std::f32::consts::TAU * along / 8.0).sin();
    let fixture = fixture(&[left(), right()]);
    let mut before = fixture.pixels(&[[0.0]; 2], [0.0]);
    for (pixel, face) in fixture.face.iter().enumerate() {
        let place = [pixel % SIZE as usize, pixel / SIZE as usize].map(|value| value as f32 + 0.5);
        before.data[pixel] = match face {
            Some(0) => wave(28.6 - place[1]),
            // Along the turned chart's edge, as long, from its first corner to its last.
            Some(_) => wave((-12.0 * (place[0] - 40.2) + 16.0 * (place[1] - 20.4)) / 20.0),
            None => 0.0,
        };
    }
    let difference = fixture.samples.height_difference(&before);
    assert!((0.01..0.08).contains(&difference), "{difference}");
    let mut after = before.clone();
    fixture.samples.erase_heights(&mut after);
    let left_over = fixture.samples.height_difference(&after);
    // Between two texels of the straight chart its side of the seam is linear. The best line differs from a parabola of
    // curvature k² by k² h² / √720 (root mean square), and from a sine by 1/√2 of that: the least difference in reach.
    let bound = (std::f64::consts::TAU / 8.0).powi(2) / 1440_f64.sqrt();
    assert!(
        bound < difference && left_over < 1.05 * bound,
        "{left_over} of {difference}, {bound}"
    );
    let changes = before
        .data
        .iter()
        .zip(&after.data)
        .map(|(old, new)| f64::from(new - old));
    let changes: Vec<f64> = changes.filter(|change| *change != 0.0).collect();
    let squares: f64 = changes.iter().map(|change| change * change).sum();
    let change = (squares / changes.len() as f64).sqrt();
    assert!(change < difference, "{change} for {difference}");
}

#[test]
fn both_sides_of_a_slope_are_compared_in_space() {
    let fixture = fixture(&[left(), right()]);
    let tilted = |face: usize, along: f32| {
        let length = (1.0 + along * along).sqrt();
        stored(&fixture.mesh, 4 * face, [along / length, 0.0, 1.0 / length])
    };
    let same = fixture.pixels(&[tilted(0, 0.4), tilted(1, 0.4)], [0.0, 0.0, 1.0]);
    let alike = fixture.samples.normal_difference(&fixture.mesh, &same);
    assert!(alike < 1e-6, "one slope, told in two frames: {alike}");
    let before = fixture.pixels(&[tilted(0, 0.4), tilted(1, 0.6)], [0.0, 0.0, 1.0]);
    let difference = fixture.samples.normal_difference(&fixture.mesh, &before);
    let angle = f64::atan(0.6) - f64::atan(0.4);
    assert!((difference - angle).abs() < 0.01 * angle, "{difference} for {angle}");
    let mut after = before.clone();
    fixture.samples.erase_normals(&fixture.mesh, &mut after);
    let left_over = fixture.samples.normal_difference(&fixture.mesh, &after);
    assert!(left_over < 0.05 * angle, "{left_over} of {angle}");
    let pairs = before.data.chunks(3).zip(after.data.chunks(3));
    for (pixel, (old, new)) in pairs.enumerate() {
        if fixture.away(pixel) > 1.5 || fixture.face[pixel].is_none() {
            assert_eq!(old, new, "pixel {pixel}");
        }
        let length = new.iter().map(|value| value * value).sum::<f32>().sqrt();
        assert!((length - 1.0).abs() < 1e-6, "{length}");
    }
}

#[test]
fn equal_values_on_both_sides_are_not_changed() {
    for fixture in [fixture(&[left(), right()]), fixture(&[left(), down()])] {
        let before = fixture.pixels(&[[0.1]; 2], [0.3]);
        let mut after = before.clone();
        fixture.samples.erase_heights(&mut after);
        assert_eq!(before, after);
        let before = fixture.pixels(&[[0.0, 0.0, 1.0]; 2], [0.0, 0.0, 1.0]);
        let mut after = before.clone();
        fixture.samples.erase_normals(&fixture.mesh, &mut after);
        assert_eq!(before, after);
    }
}

#[test]
fn a_hard_edge_keeps_its_normals_but_not_a_step_of_the_height() {
    let fixture = fixture(&[left(), down()]);
    let before = fixture.pixels(&[[0.6, 0.0, 0.8], [0.0, 0.6, 0.8]], [0.0, 0.0, 1.0]);
    let mut after = before.clone();
    fixture.samples.erase_normals(&fixture.mesh, &mut after);
    assert_eq!(before, after);
    let mut heights = fixture.pixels(&[[0.0], [1.0]], [0.0]);
    fixture.samples.erase_heights(&mut heights);
    assert!(fixture.samples.height_difference(&heights) < 0.05);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let erased = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let fixture = fixture(&[left(), right()]);
            let mut heights = fixture.pixels(&[[0.0], [1.0]], [0.0]);
            // Uneven values, as heights are.
            for (pixel, height) in heights.data.iter_mut().enumerate() {
                *height += (pixel as f32 * 0.37).sin();
            }
            let mut normals = fixture.pixels(&[[0.6, 0.0, 0.8], [0.0, 0.6, 0.8]], [0.0, 0.0, 1.0]);
            fixture.samples.erase_heights(&mut heights);
            fixture.samples.erase_normals(&fixture.mesh, &mut normals);
            [heights.data, normals.data].map(|data| data.into_iter().map(f32::to_bits).collect::<Vec<u32>>())
        })
    };
    let once = erased(1);
    assert_eq!(once, erased(1));
    assert_eq!(once, erased(4));
}

#[test]
fn padding_repeats_what_was_erased() {
    let fixture = fixture(&[left(), right()]);
    let padding = PaddingMap::new(&fixture.layout, Padding::Infinite);
    let mut heights = fixture.pixels(&[[0.0], [1.0]], [0.0]);
    fixture.samples.erase_heights(&mut heights);
    padding.pad(&crate::Channel::Height, &mut heights);
    for (pixel, from) in padding.sources().enumerate() {
        assert_eq!(heights.data[pixel], heights.data[from as usize]);
    }
}

#[test]
fn stacked_charts_and_nan_do_not_affect_other_texels() {
    // The chart of the right face lies on that of the left one, which has the pixels: nothing of the right one is shown.
    let mut stacked = right();
    stacked.texels = left().texels;
    let fixture = fixture(&[left(), stacked]);
    assert!(fixture.samples.is_empty());
    let mut heights = fixture.pixels(&[[0.5], [1.0]], [0.0]);
    let before = heights.clone();
    fixture.samples.erase_heights(&mut heights);
    assert_eq!(before, heights);

    let fixture = self::fixture(&[left(), right()]);
    let mut heights = fixture.pixels(&[[0.0], [1.0]], [0.0]);
    let beside =
        (0..fixture.face.len()).find(|&pixel| fixture.layout.cover[pixel] == Cover::Owned && fixture.away(pixel) < 0.5);
    heights.data[beside.unwrap()] = f32::NAN;
    fixture.samples.erase_heights(&mut heights);
    let broken = heights.data.iter().filter(|height| !height.is_finite()).count();
    assert_eq!(broken, 1);
    let wrong = ChannelPixels {
        components: 1,
        data: vec![0.0; 3],
    };
    let mut kept = wrong.clone();
    fixture.samples.erase_heights(&mut kept);
    assert_eq!(kept, wrong, "pixels of another size");
}

#[test]
fn a_seam_without_length_on_the_map_has_no_effect() {
    let mut flat = right();
    flat.texels = [[40.0, 40.0]; 4];
    let fixture = fixture(&[left(), flat]);
    let before = fixture.pixels(&[[0.0], [1.0]], [0.0]);
    let mut after = before.clone();
    fixture.samples.erase_heights(&mut after);
    assert_eq!(before, after);
}
