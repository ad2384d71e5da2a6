//! A relief of known slope on flat faces, and the slope that its exported normals stand for.

use glam::{DVec2, DVec3, dvec2};
use sabi_tests::{MadeMesh, MeshFile, NodeFolder, OnMesh, Quad};

/// A node of the test's own: no built-in one makes waves.
const WAVES: &str = "\
//! Waves
//! A wavy relief of known slope.

struct Params {
    /// Direction in which the waves follow each other.
    /// @default 1 0 0
    along: vec3f,
    /// From crest to crest.
    /// @length @range 0.001 10 @default 0.25
    wavelength: f32,
    /// Height of a crest.
    /// @length @range 0 1 @default 0.01
    amplitude: f32,
}

/// Plain gray with the waves.
fn material(at: Surface, params: Params) -> Material {
    var result = plain_material();
    let turns = dot(at.position, params.along) / params.wavelength;
    result.height = params.amplitude * sin(6.2831853 * (turns - floor(turns)));
    return result;
}
";

/// The same waves as a mask from 0 to 1.
const WAVES_MASK: &str = "\
//! Waves as a mask
//! A wave between 0 and 1.

struct Params {
    /// Direction in which the waves follow each other.
    /// @default 1 0 0
    along: vec3f,
    /// From crest to crest.
    /// @length @range 0.001 10 @default 0.25
    wavelength: f32,
}

/// The waves.
fn mask(at: Surface, params: Params) -> f32 {
    let turns = dot(at.position, params.along) / params.wavelength;
    return 0.5 + 0.5 * sin(6.2831853 * (turns - floor(turns)));
}
";

/// A filter that leaves all texels of charts as they are: what stands on ghosts afterwards came over the seams.
const KEEP: &str = "\
//! Keep
//! Does nothing, as a filter.
//! @use surface

/// The same mask.
/// @input source Any mask.
fn mask(at: Surface, source: texture_2d_array<f32>) -> f32 {
    return surface_here(source, at).x;
}
";

/// Waves over a plane.
#[derive(Clone, Copy)]
pub(crate) struct Waves {
    /// Unit vector.
    pub(crate) along: DVec3,
    pub(crate) wavelength: f64,
    pub(crate) amplitude: f64,
}

impl Waves {
    /// In the plane z = 0, at an angle to the x axis.
    pub(crate) fn new(degrees: f64, wavelength: f64, amplitude: f64) -> Waves {
        Waves {
            along: DVec2::from_angle(degrees.to_radians()).extend(0.0),
            wavelength,
            amplitude,
        }
    }

    /// 2π / wavelength.
    pub(crate) fn wave_number(&self) -> f64 {
        std::f64::consts::TAU / self.wavelength
    }

    /// Steepest slope.
    pub(crate) fn steepest(&self) -> f64 {
        self.amplitude * self.wave_number()
    }

    /// a k cos(k x), along the waves' direction.
    pub(crate) fn slope(&self, position: DVec3) -> DVec3 {
        let k = self.wave_number();
        self.along * self.amplitude * k * (k * position.dot(self.along)).cos()
    }

    /// The waves on a model whose largest side is 1.
    pub(crate) fn on(&self, mesh: &MadeMesh, size: u32) -> OnMesh {
        let folder = NodeFolder::new(&[("own/waves", WAVES)]);
        let graph = format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{ "waves": {{ "kind": "own/waves", "params": {{
                "along": [{}, {}, {}], "wavelength": {}, "amplitude": {} }} }} }} }}"#,
            self.along.x, self.along.y, self.along.z, self.wavelength, self.amplitude
        );
        OnMesh::with_kinds(&graph, folder.kinds(), mesh.path(), size)
    }

    /// The waves as a mask that goes through a filter, given as the members of its node, and is the height of a layer
    /// then, on a model whose largest side is 1.
    pub(crate) fn filtered_on(&self, filter: &str, mesh: &MadeMesh, size: u32) -> OnMesh {
        let folder = NodeFolder::new(&[("own/waves_mask", WAVES_MASK), ("own/keep", KEEP)]);
        let graph = format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{
                "source": {{ "kind": "own/waves_mask", "params": {{
                    "along": [{}, {}, {}], "wavelength": {} }} }},
                "filter": {{ {filter}, "inputs": {{ "source": "source" }} }},
                "waves": {{ "kind": "effect/layer", "inputs": {{ "height_map": "filter" }},
                    "params": {{ "height": {} }} }} }} }}"#,
            self.along.x,
            self.along.y,
            self.along.z,
            self.wavelength,
            2.0 * self.amplitude
        );
        OnMesh::with_kinds(&graph, folder.kinds(), mesh.path(), size)
    }

    /// Waves that remain after a blur of that radius: heat after the time radius² / 2.
    pub(crate) fn blurred(&self, radius: f64) -> Waves {
        let exponent = -0.5 * (self.wave_number() * radius).powi(2);
        Waves {
            amplitude: self.amplitude * exponent.exp(),
            ..*self
        }
    }
}

/// For each owned texel of a flat model: index, place, and the slope that the exported normal stands for, decoded as a
/// renderer does it.
pub(crate) fn decoded_slopes(on_mesh: &mut OnMesh, node: &str) -> Vec<(usize, DVec3, DVec3)> {
    let evaluated = on_mesh.evaluate(node);
    let [x, y, z] = ["normal.x", "normal.y", "normal.z"].map(|name| evaluated.component(name));
    let decode = |(index, triangle): (usize, u32)| {
        let [_, column, row] = on_mesh.texel(index);
        let at = dvec2(f64::from(column) + 0.5, f64::from(row) + 0.5);
        let [tangent, bitangent, normal] = on_mesh.frame_at(triangle, at);
        let tilted = tangent * f64::from(x[index]) + bitangent * f64::from(y[index]) + normal * f64::from(z[index]);
        let up = normal.normalize();
        let slope = up - tilted / tilted.dot(up);
        (index, on_mesh.position(index).expect("an owned texel"), slope)
    };
    on_mesh.owned().map(decode).collect()
}

/// A chart of a flat face: turned by degrees, mirrored or not, and so many units of UV for one of length.
#[derive(Clone, Copy)]
pub(crate) struct Chart {
    pub(crate) degrees: f32,
    pub(crate) is_mirrored: bool,
    pub(crate) density: [f32; 2],
    pub(crate) center: [f32; 2],
}

impl Chart {
    /// Straight, so many units of UV for one of length, around the middle of the unit square.
    pub(crate) fn straight(density: f32) -> Chart {
        Chart {
            degrees: 0.0,
            is_mirrored: false,
            density: [density; 2],
            center: [0.5, 0.5],
        }
    }

    /// A face of the plane z = 0 from (x0, y0) to (x1, y1).
    pub(crate) fn face(&self, [x0, y0]: [f32; 2], [x1, y1]: [f32; 2]) -> Quad {
        let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
        let middle = [0.5 * (x0 + x1), 0.5 * (y0 + y1)];
        let (sine, cosine) = self.degrees.to_radians().sin_cos();
        let uv = |[x, y]: [f32; 2]| {
            let side = if self.is_mirrored { -1.0 } else { 1.0 };
            let [x, y] = [
                side * self.density[0] * (x - middle[0]),
                self.density[1] * (y - middle[1]),
            ];
            [
                self.center[0] + cosine * x - sine * y,
                self.center[1] - sine * x - cosine * y,
            ]
        };
        Quad {
            corners: corners.map(|[x, y]| [x, y, 0.0]),
            uvs: corners.map(uv),
        }
    }
}

/// A plane of one by one around the origin.
pub(crate) fn plane(chart: Chart) -> MadeMesh {
    MeshFile::new(vec![chart.face([-0.5, -0.5], [0.5, 0.5])]).write()
}
