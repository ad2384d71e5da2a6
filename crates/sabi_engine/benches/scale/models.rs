//! Models of any size: a rolling ground of squares, cut into as many charts and materials as asked for.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::json;

/// Numbers of the parts of a model.
#[derive(Clone, Copy)]
pub(crate) struct Counts {
    pub(crate) triangles: usize,
    pub(crate) charts: usize,
    pub(crate) materials: usize,
}

/// Corners and triangles of a material.
#[derive(Default)]
struct MeshBuffers {
    positions: Vec<f32>,
    uvs: Vec<f32>,
    indices: Vec<u32>,
}

/// Writes a model as GLB. Charts are blocks of the ground, which lie in the sheet as they do there; materials take turns.
pub(crate) fn write(folder: &Path, counts: Counts) -> PathBuf {
    let side = ((counts.triangles as f64 / 2.0).sqrt().round() as usize).max(counts.charts.isqrt().max(1));
    let blocks = counts.charts.isqrt().max(1);
    let mut parts: Vec<MeshBuffers> = (0..counts.materials).map(|_| MeshBuffers::default()).collect();
    for block in 0..blocks * blocks {
        let edges = |at: usize| [at * side / blocks, (at + 1) * side / blocks];
        let [columns, rows] = [edges(block % blocks), edges(block / blocks)];
        parts[block % counts.materials].add(side, blocks, columns, rows);
    }
    let path = folder.join("scale.glb");
    fs::write(&path, glb(&parts)).unwrap();
    path
}

impl MeshBuffers {
    /// Adds the squares of some columns and rows as a chart of their own.
    fn add(&mut self, side: usize, blocks: usize, columns: [usize; 2], rows: [usize; 2]) {
        let first = (self.positions.len() / 3) as u32;
        let across = (columns[1] - columns[0] + 1) as u32;
        for row in rows[0]..=rows[1] {
            for column in columns[0]..=columns[1] {
                let [x, z] = [column, row].map(|at| at as f32 / side as f32);
                let y = 0.1 * (9.0 * x).sin() * (7.0 * z).cos();
                self.positions.extend([x, y, z]);
                // A gap around each chart.
                let place = |at: usize, ends: [usize; 2]| {
                    let middle = 0.5 * (ends[0] + ends[1]) as f32 / side as f32;
                    let share = if blocks == 1 { 0.98 } else { 0.7 };
                    middle + (at as f32 / side as f32 - middle) * share
                };
                self.uvs.extend([place(column, columns), place(row, rows)]);
            }
        }
        for row in 0..(rows[1] - rows[0]) as u32 {
            for column in 0..across - 1 {
                let at = first + row * across + column;
                self.indices
                    .extend([at, at + across, at + 1, at + 1, at + across, at + across + 1]);
            }
        }
    }
}

/// A binary glTF with a mesh that has a primitive for each part.
fn glb(parts: &[MeshBuffers]) -> Vec<u8> {
    let mut binary: Vec<u8> = Vec::new();
    let (mut views, mut accessors, mut primitives, mut materials) = (vec![], vec![], vec![], vec![]);
    for (number, part) in parts.iter().enumerate().filter(|(_, part)| !part.indices.is_empty()) {
        let floats = |values: &[f32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
        let indices: Vec<u8> = part.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let vertices = part.positions.len() / 3;
        let planes = [
            (floats(&part.positions), 5126, vertices, "VEC3"),
            (floats(&part.uvs), 5126, vertices, "VEC2"),
            (indices, 5125, part.indices.len(), "SCALAR"),
        ];
        let first = accessors.len();
        for (bytes, component, count, shape) in planes {
            let mut accessor =
                json!({ "bufferView": views.len(), "componentType": component, "count": count, "type": shape });
            if shape == "VEC3" {
                accessor["min"] = json!([0.0, -0.1, 0.0]);
                accessor["max"] = json!([1.0, 0.1, 1.0]);
            }
            views.push(json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len() }));
            accessors.push(accessor);
            binary.extend(bytes);
        }
        primitives.push(json!({
            "attributes": { "POSITION": first, "TEXCOORD_0": first + 1 }, "indices": first + 2, "material": materials.len()
        }));
        materials.push(json!({ "name": format!("m{number}") }));
    }
    let mut text = json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": primitives }], "materials": materials, "accessors": accessors, "bufferViews": views,
        "buffers": [{ "byteLength": binary.len() }]
    })
    .to_string();
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend(((28 + text.len() + binary.len()) as u32).to_le_bytes());
    file.extend((text.len() as u32).to_le_bytes());
    file.extend(b"JSON");
    file.extend(text.as_bytes());
    file.extend((binary.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(binary);
    file
}
