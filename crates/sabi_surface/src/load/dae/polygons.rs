//! Lists of polygons: `triangles`, `polylist`, `polygons`, `trifans`, `tristrips`.

use roxmltree::Node;
use sabi_cancel::CancelableIterator as _;

use super::document::{DaeDocument, child, children, text};
use crate::load::error::{ModelFault, damaged};
use crate::load::warnings::Warnings;

/// Maximum number of indices of a corner. A real file has a few attributes and sets of texture coordinates.
const MOST_OFFSETS: usize = 1024;

/// Attribute of the corners.
#[derive(Clone, Copy)]
pub(super) struct DaeInput<'d> {
    semantic: &'d str,
    /// The `source` of its numbers.
    pub(super) source: Node<'d, 'd>,
    /// Position of the index among the indices of a corner.
    offset: usize,
    /// Number by which a file distinguishes sets of texture coordinates.
    pub(super) set: u32,
}

/// Polygons with the same inputs.
pub(super) struct Polygons<'d> {
    inputs: Vec<DaeInput<'d>>,
    /// Corners of each polygon, three or more.
    pub(super) counts: Vec<u32>,
    /// Rows of `stride` indices, one for each corner.
    indices: Vec<u32>,
    stride: usize,
}

impl<'d> Polygons<'d> {
    /// Reads a list of the mesh `who`; `None` if the element is not a list of polygons.
    pub(super) fn read(
        document: &DaeDocument<'d>,
        list: Node<'d, 'd>,
        who: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<Polygons<'d>>, ModelFault> {
        let kind = list.tag_name().name();
        match kind {
            "triangles" | "polylist" | "polygons" | "trifans" | "tristrips" => {}
            "lines" | "linestrips" => {
                warnings.add(format!("Points and lines of {who} are left out."));
                return Ok(None);
            }
            _ => return Ok(None),
        }
        let inputs = inputs(document, list);
        let stride = inputs.iter().map(|input| input.offset + 1).max().unwrap_or(1);
        if stride > MOST_OFFSETS {
            return damaged(format!("a corner of {who} has {stride} indices"));
        }
        let mut polygons = Polygons {
            inputs,
            counts: Vec::new(),
            indices: Vec::new(),
            stride,
        };
        let holed = children(list, "ph").filter_map(|holed| child(holed, "p"));
        let holed: Vec<Node> = holed.collect();
        if !holed.is_empty() {
            warnings.add(format!(
                "Holes in the faces of {who} are left out; triangulate the model on export."
            ));
        }
        for outline in children(list, "p").chain(holed) {
            let rows = indices(outline)?;
            match kind {
                "triangles" => polygons.add(&rows, std::iter::repeat(3), warnings)?,
                "polylist" => {
                    let counts = child(list, "vcount").map_or(Ok(Vec::new()), indices)?;
                    polygons.add(&rows, counts.into_iter(), warnings)?;
                }
                "polygons" => {
                    let corners = (rows.len() / stride) as u32;
                    polygons.add(&rows, std::iter::once(corners), warnings)?;
                }
                _ => polygons.add_strip(&rows, kind == "trifans"),
            }
        }
        Ok(Some(polygons))
    }

    /// Returns the number of triangles into which the polygons are divided.
    pub(super) fn triangles(&self) -> u64 {
        self.counts.iter().map(|count| u64::from(*count) - 2).sum()
    }

    /// Returns the first input with this semantic.
    pub(super) fn input(&self, semantic: &str) -> Option<DaeInput<'d>> {
        self.inputs.iter().copied().find(|input| input.semantic == semantic)
    }

    /// The inputs of texture coordinates.
    pub(super) fn uv_inputs(&self) -> impl Iterator<Item = DaeInput<'d>> {
        self.inputs.iter().copied().filter(|input| input.semantic == "TEXCOORD")
    }

    /// The index of each corner for an input.
    pub(super) fn corners(&self, input: DaeInput<'d>) -> impl Iterator<Item = u32> {
        self.indices.iter().skip(input.offset).step_by(self.stride).copied()
    }

    /// Adds polygons with the given numbers of corners.
    fn add(
        &mut self,
        rows: &[u32],
        counts: impl Iterator<Item = u32>,
        warnings: &mut Warnings,
    ) -> Result<(), ModelFault> {
        let mut rest = rows;
        for count in counts.looking() {
            if rest.len() < self.stride {
                break;
            }
            let length = (count as usize).saturating_mul(self.stride);
            let Some((polygon, after)) = rest.split_at_checked(length) else {
                return damaged(format!("a polygon promises {count} corners, and there are fewer"));
            };
            rest = after;
            if count >= 3 {
                self.counts.push(count);
                self.indices.extend(polygon);
            } else {
                warnings.add("Faces with fewer than 3 corners are left out.");
            }
        }
        Ok(())
    }

    /// Adds the triangles of a strip or a fan.
    fn add_strip(&mut self, rows: &[u32], is_fan: bool) {
        let corners: Vec<&[u32]> = rows.chunks_exact(self.stride).collect();
        for third in (2..corners.len()).looking() {
            let triangle = match (is_fan, third % 2) {
                (true, _) => [0, third - 1, third],
                (false, 0) => [third - 2, third - 1, third],
                (false, _) => [third - 1, third - 2, third],
            };
            self.counts.push(3);
            for corner in triangle {
                self.indices.extend(corners[corner]);
            }
        }
    }
}

/// Returns the attributes of a list's corners. Attributes of vertices share the index of the vertex.
fn inputs<'d>(document: &DaeDocument<'d>, list: Node<'d, 'd>) -> Vec<DaeInput<'d>> {
    let mut inputs = Vec::new();
    for input in children(list, "input") {
        let number = |name: &str| input.attribute(name).and_then(|value| value.parse().ok());
        // Without offsets, all inputs share one index. Without sets, there is one set.
        let [offset, set] = ["offset", "set"].map(|name| number(name).unwrap_or(0u32));
        let add = |of: Node<'d, 'd>| {
            Some(DaeInput {
                semantic: of.attribute("semantic")?,
                source: document.referenced(of, "source")?,
                offset: offset as usize,
                set,
            })
        };
        if input.attribute("semantic") == Some("VERTEX") {
            let vertices = document.referenced(input, "source");
            inputs.extend(
                vertices
                    .into_iter()
                    .flat_map(|vertices| children(vertices, "input"))
                    .filter_map(add),
            );
        } else {
            inputs.extend(add(input));
        }
    }
    inputs
}

fn indices(list: Node<'_, '_>) -> Result<Vec<u32>, ModelFault> {
    let text = text(list);
    let words = text.split_ascii_whitespace();
    let indices = words.looking().map(|word| {
        let index = word.parse();
        index.map_err(|_| ModelFault::Damaged(format!("`{word}` is not an index")))
    });
    indices.collect()
}
