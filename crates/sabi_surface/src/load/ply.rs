//! PLY, as text and binary of both byte orders: vertices, faces, normals, texture coordinates, colors.
//!
//! Integer colors are interpreted as sRGB, as in the programs that write them, and float colors as linear, unless they are codes. Texture
//! coordinates belong to vertices (`s t` or `u v`) or to the corners of faces (`texcoord`), and are converted to glTF's
//! convention (v grows downward). Images are named in comments `TextureFile`, and `texnumber` of a face is an index into
//! these. Missing normals are smooth up to an angle of 80°. The format defines neither units nor an up axis.

mod body;
mod colors;
mod header;

use sabi_cancel::CancelableIterator as _;
use std::collections::BTreeSet;

use glam::DMat4;

use self::body::{PlyBody, PropertyValue};
use self::colors::ColorProperties;
use self::header::{NumberType, PlyElement, PlyEncoding, PlyHeader};
use super::assembly::{Assembly, MeshInstance};
use super::completion::{Completion, LACKING_NORMALS};
use super::error::{ModelFault, damaged};
use super::faces::{Faces, NONE};
use super::gltf::Resolve;
use super::normals::NormalMethod;
use super::polygon::Budget;
use super::size::check_size;
use super::submesh::Smoothing;
use super::warnings::Warnings;
use super::{LoadOptions, MAX_TRIANGLES};
use crate::model::{Model, ModelMaterial, TextureRef};

/// First bytes of each file.
pub(super) const MARKS: [&[u8]; 3] = [b"ply\n", b"ply\r", b"ply "];

/// Names of the properties of a vertex that are read, in the order of [`PlyVertex`]. Of each list, the first name that exists is used.
const VERTEX: [&[&str]; 8] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx", "normal_x"],
    &["ny", "normal_y"],
    &["nz", "normal_z"],
    &["s", "u", "texture_u", "texture_s"],
    &["t", "v", "texture_v", "texture_t"],
];
/// Corners of a face.
const INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Reads a `.ply` file.
pub(super) fn read(
    name: &str,
    bytes: &[u8],
    resolve: &mut Resolve,
    options: &LoadOptions,
) -> Result<Model, ModelFault> {
    let mut warnings = Warnings::default();
    let (header, rest) = PlyHeader::parse(bytes)?;
    let faces = PlyReader::new(&header, &mut warnings).read(rest)?;
    check_size(faces.triangles(), 1, options.memory_bytes)?;
    let has_uvs = !faces.uvs.values.is_empty();
    if options.uv_set > 0 {
        return Err(ModelFault::UvSet {
            asked: options.uv_set,
            there: if has_uvs {
                "PLY files have set 0 alone"
            } else {
                "it has no UVs at all"
            }
            .into(),
        });
    }
    let has_faces = ["face", "tristrips"]
        .into_iter()
        .any(|name| header.element(name).is_some_and(|faces| faces.count > 0));
    if !has_faces && !faces.positions.is_empty() {
        warnings.add("it is a cloud of points without faces; make a mesh of them first");
    }
    let completion = Completion {
        repaired_normals: LACKING_NORMALS,
        missing: NormalMethod::Crease,
        smooth_degrees: options.smooth_degrees,
    };
    let mut submesh = faces.triangulated(&mut Budget::default(), &mut warnings);
    completion.complete(&mut submesh, &BTreeSet::new(), "the model", &mut warnings);
    let mut assembly = Assembly {
        meshes: vec![vec![submesh]],
        uv_sets: has_uvs.then_some(0).into_iter().collect(),
        ..Assembly::default()
    };
    for picture in &header.pictures {
        let texture = TextureRef::of(assembly.pictures.beside(picture));
        assembly.materials.push(ModelMaterial {
            // A single material needs no name.
            name: if header.pictures.len() > 1 {
                super::stem(picture)
            } else {
                String::new()
            },
            base_color: Some(texture),
            base_color_factor: [1.0; 4],
            ..ModelMaterial::plain()
        });
    }
    assembly.instances.push(MeshInstance {
        mesh: 0,
        name: super::stem(name),
        group: None,
        file_from_mesh: DMat4::IDENTITY,
        materials: (0..assembly.materials.len() as u32).collect(),
    });
    assembly.into_model(name, resolve, options, warnings)
}

/// Values of a vertex, in the order of [`VERTEX`].
type PlyVertex = [f32; VERTEX.len()];

/// Reader of the elements after a header.
struct PlyReader<'h, 'w> {
    header: &'h PlyHeader,
    warnings: &'w mut Warnings,
    faces: Faces,
    vertices: u64,
    /// True if faces have their own texture coordinates, which replace those of vertices.
    corners_have_uvs: bool,
    /// True if faces have colors and vertices have none.
    faces_have_colors: bool,
    /// Name in warnings of the elements whose colors are read, and the channels of these colors.
    colored: Option<(&'static str, ColorProperties)>,
}

impl PlyReader<'_, '_> {
    fn new<'h, 'w>(header: &'h PlyHeader, warnings: &'w mut Warnings) -> PlyReader<'h, 'w> {
        let colors_of = |name: &str| {
            header
                .element(name)
                .is_some_and(|element| ColorProperties::of(element).are_there())
        };
        PlyReader {
            header,
            warnings,
            faces: Faces::default(),
            vertices: header.element("vertex").map_or(0, |element| element.count),
            corners_have_uvs: header
                .element("face")
                .is_some_and(|face| face.place("texcoord").is_some()),
            faces_have_colors: colors_of("face") && !colors_of("vertex"),
            colored: None,
        }
    }

    fn read(mut self, rest: &[u8]) -> Result<Faces, ModelFault> {
        let mut body = PlyBody::new(self.header.encoding, rest);
        for element in &self.header.elements {
            // Every element takes bytes, so a count that does not fit into the file is refused before anything is read.
            body.check_room(element)?;
            match element.name.as_str() {
                "vertex" => self.read_vertices(element, &mut body)?,
                "face" => self.read_faces(element, &mut body)?,
                "tristrips" => self.read_strips(element, &mut body)?,
                _ => body.skip(element)?,
            }
        }
        self.warnings.absorb(body.warnings);
        if let Some((whose, colors)) = &self.colored {
            colors.make_linear(&mut self.faces.colors.values, whose, self.warnings);
        }
        self.warn_of_materials();
        self.share_attributes();
        Ok(self.faces)
    }

    /// Adds a warning about materials, which are lists of numbers in some files.
    fn warn_of_materials(&mut self) {
        let mut elements = self.header.elements.iter();
        if elements.any(|element| element.name == "material" || element.place("material_index").is_some()) {
            self.warnings
                .add("The materials of the file (`material`, `material_index`) are left out.");
        }
    }

    fn read_vertices(&mut self, element: &PlyElement, body: &mut PlyBody) -> Result<(), ModelFault> {
        let places = VERTEX.map(|names| names.iter().find_map(|name| element.place(name)));
        let has = |range: std::ops::Range<usize>| places[range].iter().all(Option::is_some);
        if !has(0..3) {
            return damaged("its vertices have no `x`, `y` and `z`");
        }
        let [with_normals, with_uvs] = [has(3..6), has(6..8) && !self.corners_have_uvs];
        let kind_of = |channel: usize| places[channel].and_then(|place| Some(element.properties.get(place)?.kind));
        let colors = ColorProperties::of(element);
        // In a text file, the digits decide the precision, whatever type is declared.
        self.faces.is_single =
            self.header.encoding != PlyEncoding::Text && (0..3).all(|axis| kind_of(axis) == Some(NumberType::F32));
        let mut row = Vec::new();
        for _ in (0..element.count).looking() {
            body.row(element, &mut row)?;
            let number = |place: Option<usize>| match place.and_then(|place| row.get(place)) {
                Some(PropertyValue::Number(number)) => *number,
                _ => 0.0,
            };
            let [x, y, z, ..] = places.map(number);
            self.faces.positions.push([x, y, z]);
            let vertex: PlyVertex = places.map(number).map(|number| number as f32);
            let [_, _, _, nx, ny, nz, s, t] = vertex;
            if with_normals {
                self.faces.normals.values.push([nx, ny, nz]);
            }
            if with_uvs {
                self.faces.uvs.values.push([s, 1.0 - t]);
            }
            self.faces.colors.values.extend(colors.of_row(&row));
        }
        if colors.are_there() {
            self.colored = Some(("vertices", colors));
        }
        Ok(())
    }

    fn read_faces(&mut self, element: &PlyElement, body: &mut PlyBody) -> Result<(), ModelFault> {
        let Some(indices) = INDICES.iter().find_map(|name| element.place(name)) else {
            return damaged("its faces have no `vertex_indices`");
        };
        let [texcoord, texnumber] = ["texcoord", "texnumber"].map(|name| element.place(name));
        let colors = ColorProperties::of(element).filter(self.faces_have_colors);
        let lone_texture = !self.header.pictures.is_empty();
        let mut row = Vec::new();
        let mut triangles = 0u64;
        for face in (0..element.count).looking() {
            body.row(element, &mut row)?;
            let Some(PropertyValue::List(corners)) = row.get(indices) else {
                return damaged("the `vertex_indices` of its faces are no list");
            };
            if corners.len() < 3 {
                self.warnings.add("Faces with fewer than 3 corners are left out.");
                continue;
            }
            triangles += corners.len() as u64 - 2;
            if triangles > MAX_TRIANGLES {
                return Err(ModelFault::TooLarge(triangles.max(element.count)));
            }
            for corner in corners {
                if !(0.0..self.vertices as f64).contains(corner) {
                    return damaged(format!("face {face} names vertex {corner} of {}", self.vertices));
                }
                self.faces.corners.push(*corner as u32);
            }
            let texture = match texnumber.and_then(|place| row.get(place)) {
                Some(PropertyValue::Number(number)) if *number >= 0.0 => *number as u32,
                Some(_) => NONE,
                None if lone_texture => 0,
                None => NONE,
            };
            let uvs = texcoord.and_then(|place| row.get(place));
            self.push_uvs(uvs, corners.len());
            if let Some(color) = colors.of_row(&row) {
                self.faces
                    .colors
                    .corners
                    .extend(std::iter::repeat_n(face as u32, corners.len()));
                // Faces that are left out have none.
                self.faces.colors.values.resize(face as usize, [0.0; 4]);
                self.faces.colors.values.push(color);
            }
            self.faces.close(corners.len(), texture, Smoothing::ByAngle);
        }
        if colors.are_there() {
            self.colored = Some(("faces", colors));
        }
        Ok(())
    }

    /// Reads strips of triangles; a negative number ends one, and another begins behind it.
    fn read_strips(&mut self, element: &PlyElement, body: &mut PlyBody) -> Result<(), ModelFault> {
        let Some(indices) = INDICES.iter().find_map(|name| element.place(name)) else {
            return damaged("its strips have no `vertex_indices`");
        };
        let mut row = Vec::new();
        let mut triangles = 0u64;
        for _ in 0..element.count {
            body.row(element, &mut row)?;
            let Some(PropertyValue::List(corners)) = row.get(indices) else {
                return damaged("the `vertex_indices` of its strips are no list");
            };
            triangles += corners.len() as u64;
            if triangles > MAX_TRIANGLES {
                return Err(ModelFault::TooLarge(triangles));
            }
            for strip in corners.split(|corner| *corner < 0.0) {
                if let Some(beyond) = strip
                    .iter()
                    .find(|corner| corner.is_nan() || **corner >= self.vertices as f64)
                {
                    return damaged(format!("a strip names vertex {beyond} of {}", self.vertices));
                }
                for (number, triangle) in strip.windows(3).enumerate() {
                    let [first, second, third] = [0, 1, 2].map(|corner| triangle[corner] as u32);
                    // Strips join by triangles that are lines.
                    if first == second || second == third || third == first {
                        continue;
                    }
                    let turned = match number.is_multiple_of(2) {
                        true => [first, second, third],
                        false => [second, first, third],
                    };
                    self.faces.corners.extend(turned);
                    self.push_uvs(None, 3);
                    self.faces.close(3, NONE, Smoothing::ByAngle);
                }
            }
        }
        Ok(())
    }

    /// Adds the texture coordinates of a face's corners, where faces have them.
    fn push_uvs(&mut self, uvs: Option<&PropertyValue>, count: usize) {
        if !self.corners_have_uvs {
            return;
        }
        let uvs = match uvs {
            Some(PropertyValue::List(uvs)) => uvs.as_chunks::<2>().0,
            _ => &[],
        };
        for corner in 0..count {
            let number = match uvs.get(corner) {
                Some([u, v]) => {
                    self.faces.uvs.values.push([*u as f32, 1.0 - *v as f32]);
                    self.faces.uvs.values.len() as u32 - 1
                }
                None => {
                    self.warnings
                        .add("Some faces have no texture coordinates; theirs are zero.");
                    NONE
                }
            };
            self.faces.uvs.corners.push(number);
        }
    }

    /// Copies the attributes of vertices to their corners.
    fn share_attributes(&mut self) {
        let Faces {
            corners,
            normals,
            colors,
            uvs,
            ..
        } = &mut self.faces;
        normals.corners = corners.clone();
        // Strips have no colors of their own.
        match self.faces_have_colors {
            true => colors.corners.resize(corners.len(), NONE),
            false => colors.corners = corners.clone(),
        }
        if self.corners_have_uvs {
            *uvs = std::mem::take(uvs).joined();
        } else {
            uvs.corners = corners.clone();
        }
    }
}
