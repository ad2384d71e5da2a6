//! Points spread evenly over a surface, on which wide filters run.
//!
//! A coarse level of the atlas has the charts of the unwrap, and its texels are inaccurate at the borders of charts: where charts are only
//! a few texels wide, they become visible. Points do not depend on charts. They are distributed over the texels of an atlas and across the
//! links of its ghosts, so that the two sides of a thin wall stay separate. The flow between two points depends only on their positions.
//!
//! The steps, one file each: `texels` (the texels as a graph), `spread` (points and the cells around them), `rings` (the points
//! around each), `flow` (how fast values pass from point to point).

mod dart_throwing;
mod flow;
mod rings;
#[cfg(test)]
mod tests;
mod texels;

use texels::TexelGraph;

use crate::atlas::{Atlas, EMPTY};
use crate::model::Mesh;

/// Lists of different lengths, one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists<T> {
    /// First entry of each list, and the number of all entries at the end.
    pub starts: Vec<u32>,
    /// Entries of all lists.
    pub entries: Vec<T>,
}

impl<T> Lists<T> {
    fn new(lists: impl IntoIterator<Item = Vec<T>>) -> Lists<T> {
        let mut made = Lists {
            starts: vec![0],
            entries: Vec::new(),
        };
        for list in lists {
            made.entries.extend(list);
            made.starts.push(made.entries.len() as u32);
        }
        made
    }

    /// Entries of a list; empty where there is no such list.
    pub fn of(&self, index: usize) -> &[T] {
        match self.starts.get(index..index + 2) {
            Some([first, end]) => &self.entries[*first as usize..*end as usize],
            _ => &[],
        }
    }

    /// Number of lists.
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Returns whether there is no list.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A point with the part of the surface around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Center of its cell, in model units.
    pub position: [f32; 3],
    /// Mean normal of the faces of its cell, unit length.
    pub normal: [f32; 3],
    /// Two directions along the surface, unit length. The cross product of the second and the first is the normal.
    pub axes: [[f32; 3]; 2],
    /// Area of its cell, square model units.
    pub area: f64,
    /// Index of the nearest texel of the atlas in [`Atlas::owners`].
    pub texel: u32,
}

/// Share of the difference from another point that flows in a unit of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow {
    /// The other point.
    pub to: u32,
    /// Rate, in units of the time in which a value spreads by the spacing of the points: a variance of twice its square.
    pub rate: f32,
}

/// A texel of the cell of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellTexel {
    /// Its index in [`Atlas::owners`].
    pub texel: u32,
    /// Its share of the area of the cell.
    pub share: f32,
}

/// Points distributed over a surface, with distances of 1 to 1.5 spacings. Each is the center of a cell of texels.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacePoints {
    /// Minimum distance of two points when they were distributed, model units.
    pub spacing: f64,
    /// All points.
    pub points: Vec<SurfacePoint>,
    /// For each point, the flows to it.
    pub flows: Lists<Flow>,
    /// For each point: the point, its neighbors, and their neighbors.
    pub around: Lists<u32>,
    /// For each point the texels of its cell.
    pub cells: Lists<CellTexel>,
    /// For each texel of the atlas, the point whose cell contains it; [`EMPTY`] for texels that are not owned.
    pub point_of_texel: Vec<u32>,
}

impl SurfacePoints {
    /// Distributes points over the texels of an atlas, which should not be wider than a third of the spacing. The same
    /// mesh, atlas and spacing give the same points.
    ///
    /// Points are spread by dart throwing along the surface (Cook 1986) and moved to the centers of their cells (Lloyd 1982);
    /// values flow between cells that touch, as fast as their common border is long and their points are near (the two-point
    /// flux of finite volumes on Voronoi cells, Eymard, Gallouët, Herbin 2000).
    pub fn spread(mesh: &Mesh, atlas: &Atlas, spacing: f64) -> SurfacePoints {
        let graph = TexelGraph::new(mesh, atlas);
        let cells = dart_throwing::cells(&graph, spacing);
        let around = rings::around(&graph, &cells.point_of_texel, cells.centers.len());
        let members = cells.members();
        let flows = flow::flows(&graph, &cells, &members, &around, spacing);
        let mut point_of_texel = vec![EMPTY; atlas.owners.len()];
        for (texel, point) in graph.texels.iter().zip(&cells.point_of_texel) {
            point_of_texel[texel.index as usize] = *point;
        }
        SurfacePoints {
            spacing,
            points: cells.points(&graph),
            flows,
            around,
            cells: cells.texels(&graph, &members),
            point_of_texel,
        }
    }
}
