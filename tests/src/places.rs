//! Places of texels on the surface, and results between texels; computed here, without any kernel.

use glam::{DVec2, DVec3, dvec2};
use sabi_surface::atlas::{Atlas, Owner};

use crate::on_mesh::OnMesh;

/// A place on a chart: page, and texel coordinates on it.
pub type OnPage = (u32, DVec2);

impl OnMesh {
    /// The atlas.
    pub fn atlas(&self) -> &Atlas {
        &self.evaluator.linked().atlas
    }

    /// All owned texels: index and triangle.
    pub fn owned(&self) -> impl Iterator<Item = (usize, u32)> + '_ {
        (0..self.atlas().owners.len()).filter_map(|index| match self.owner(index) {
            Owner::Triangle(triangle) => Some((index, triangle)),
            Owner::Empty | Owner::Ghost(_) => None,
        })
    }

    /// All owned and ghost texels.
    pub fn covered(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.atlas().owners.len()).filter(|index| self.owner(*index) != Owner::Empty)
    }

    /// Page, column and row of a texel.
    pub fn texel(&self, index: usize) -> [u32; 3] {
        let [width, height] = self.atlas().page_size.map(|side| side as usize);
        [
            (index / (width * height)) as u32,
            (index % width) as u32,
            ((index / width) % height) as u32,
        ]
    }

    /// The index of a texel.
    pub fn index(&self, [page, x, y]: [u32; 3]) -> usize {
        let [width, height] = self.atlas().page_size.map(|side| side as usize);
        (page as usize * height + y as usize) * width + x as usize
    }

    /// Owner of a texel.
    pub fn owner(&self, index: usize) -> Owner {
        let [page, x, y] = self.texel(index);
        self.atlas().owner(x, y, page)
    }

    /// Chart of an owned texel, or of the ring that a ghost belongs to.
    pub fn chart(&self, index: usize) -> Option<u32> {
        match self.owner(index) {
            Owner::Empty => None,
            Owner::Triangle(triangle) => Some(self.atlas().triangle_chart[triangle as usize]),
            Owner::Ghost(ghost) => Some(self.atlas().ghosts[ghost as usize].chart),
        }
    }

    /// The surface point of a texel in working units; a ghost's lies over the seam.
    pub fn position(&self, index: usize) -> Option<DVec3> {
        let [_, x, y] = self.texel(index);
        match self.owner(index) {
            Owner::Empty => None,
            Owner::Triangle(triangle) => {
                Some(self.position_at(triangle, dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5)))
            }
            Owner::Ghost(ghost) => {
                let ghost = self.atlas().ghosts[ghost as usize];
                Some(self.position_at(ghost.target_triangle, DVec2::from(ghost.target_texel.map(f64::from))))
            }
        }
    }

    fn position_at(&self, triangle: u32, at: DVec2) -> DVec3 {
        self.affine(triangle, at, [0, 1, 2])
    }

    /// The shading normal and the tangent of a triangle's frame at texel coordinates, not normalized, and the sign of
    /// the bitangent: what a renderer decodes the exported map with.
    pub fn frame_at(&self, triangle: u32, at: DVec2) -> [DVec3; 3] {
        let normal = self.affine(triangle, at, [3, 4, 5]);
        let rows = &self.tables.frames[4 * triangle as usize..];
        let step = self.step(triangle, at);
        let row = |at: usize| DVec3::from([rows[at][0], rows[at][1], rows[at][2]].map(f64::from));
        let tangent = row(0) + row(1) * step.x + row(2) * step.y;
        let sign = f64::from(self.tables.bitangent_sign(triangle as usize));
        [tangent, sign * normal.cross(tangent), normal]
    }

    fn step(&self, triangle: u32, at: DVec2) -> DVec2 {
        let rows = &self.tables.geometry[6 * triangle as usize..];
        at - dvec2(f64::from(rows[0][3]), f64::from(rows[1][3]))
    }

    fn affine(&self, triangle: u32, at: DVec2, rows: [usize; 3]) -> DVec3 {
        let table = &self.tables.geometry[6 * triangle as usize..];
        let row = |at: usize| DVec3::from([table[at][0], table[at][1], table[at][2]].map(f64::from));
        let step = self.step(triangle, at);
        row(rows[0]) + row(rows[1]) * step.x + row(rows[2]) * step.y
    }

    /// The place of a point of a triangle, given by the weights of its corners, on the triangle's own chart.
    pub fn on_page(&self, triangle: u32, weights: [f64; 3]) -> OnPage {
        let atlas = self.atlas();
        let chart = &atlas.charts[atlas.triangle_chart[triangle as usize] as usize];
        let corners = atlas.triangle_texels[triangle as usize].map(|corner| DVec2::from(corner.map(f64::from)));
        let place = corners
            .iter()
            .zip(weights)
            .map(|(corner, weight)| *corner * weight)
            .sum();
        (chart.page, place)
    }

    /// The four texels around a place and their weights.
    ///
    /// # Panics
    /// If one of them is empty, or belongs to another chart than `chart`: a chart and its ghosts must be enough.
    pub fn taps(&self, (page, place): OnPage, chart: u32) -> [(usize, f64); 4] {
        let corner = (place - 0.5).floor();
        let weight = place - 0.5 - corner;
        std::array::from_fn(|tap| {
            let step = dvec2((tap & 1) as f64, (tap >> 1) as f64);
            let share = (1.0 - weight) * (1.0 - step) + weight * step;
            let texel = corner + step;
            let index = self.index([page, texel.x as u32, texel.y as u32]);
            assert_eq!(
                self.chart(index),
                Some(chart),
                "texel {texel} of page {page}, next to chart {chart} at {place}, is not the chart's"
            );
            (index, share.x * share.y)
        })
    }

    /// A result between texels, as a renderer sees it: bilinear, read on the triangle's own chart with its ghosts.
    pub fn bilinear(&self, values: &[f32], triangle: u32, weights: [f64; 3]) -> f64 {
        let chart = self.atlas().triangle_chart[triangle as usize];
        let taps = self.taps(self.on_page(triangle, weights), chart);
        taps.iter()
            .map(|(index, share)| f64::from(values[*index]) * share)
            .sum()
    }

    /// All owned texels with their true areas, square working units.
    pub fn areas(&self) -> Vec<(usize, f64)> {
        let area = |triangle: u32| {
            let row = |at: usize| {
                let [x, y, z, _] = self.tables.geometry[6 * triangle as usize + at];
                DVec3::from([x, y, z].map(f64::from))
            };
            row(1).cross(row(2)).length()
        };
        self.owned().map(|(index, triangle)| (index, area(triangle))).collect()
    }

    /// Mean of a result over the surface, by its true area.
    pub fn mean(&self, values: &[f32]) -> f64 {
        let areas = self.areas();
        let sum: f64 = areas.iter().map(|(index, area)| area * f64::from(values[*index])).sum();
        sum / areas.iter().map(|(_, area)| area).sum::<f64>()
    }

    /// Pairs of owned texels side by side on one chart.
    pub fn neighbors(&self) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for (index, _) in self.owned() {
            let [page, x, y] = self.texel(index);
            for beside in [[page, x + 1, y], [page, x, y + 1]] {
                let is_owned = matches!(self.atlas().owner(beside[1], beside[2], page), Owner::Triangle(_));
                if is_owned && self.chart(self.index(beside)) == self.chart(index) {
                    pairs.push((index, self.index(beside)));
                }
            }
        }
        pairs
    }
}
