//! A part under construction: triangles with chart coordinates in meters, and what becomes of them.

use std::collections::BTreeMap;

use glam::{DQuat, DVec2, DVec3};

/// A triangle corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    /// Place in the part's own space, in meters.
    pub(crate) position: DVec3,
    /// Place on the chart's sheet, in meters, y upward; counter-clockwise like the triangle unless the chart is mirrored.
    pub(crate) sheet: DVec2,
    /// Shading normal where the builder knows better than the faces.
    pub(crate) normal: Option<DVec3>,
}

/// Counter-clockwise seen from outside.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// The corners.
    pub(crate) corners: [Corner; 3],
    /// Chart within the part.
    pub(crate) chart: usize,
}

impl Triangle {
    /// The face's normal times twice its area, in square meters.
    pub(crate) fn cross(&self) -> DVec3 {
        let [a, b, c] = self.corners.map(|corner| corner.position);
        (b - a).cross(c - a)
    }
}

/// Triangles in charts.
#[derive(Clone, Debug, Default)]
pub(crate) struct ChartedMesh {
    /// All of them.
    pub(crate) triangles: Vec<Triangle>,
    /// Number of charts of the triangles.
    pub(crate) charts: usize,
}

impl ChartedMesh {
    /// Starts a chart and returns its number.
    pub(crate) fn begin_chart(&mut self) -> usize {
        self.charts += 1;
        self.charts - 1
    }

    /// Adds a triangle unless two of its corners are one place, as at the pole of a turned shape.
    pub(crate) fn triangle(&mut self, chart: usize, corners: [Corner; 3]) {
        let [a, b, c] = corners.map(|corner| place_key(corner.position));
        if a != b && b != c && c != a {
            self.triangles.push(Triangle { corners, chart });
        }
    }

    /// Adds a quad, corners counter-clockwise, cut along its shorter diagonal.
    pub(crate) fn quad(&mut self, chart: usize, [a, b, c, d]: [Corner; 4]) {
        // A hair of preference for one side keeps symmetric quads from hanging on the last bit.
        if a.position.distance(c.position) <= b.position.distance(d.position) * (1.0 + 1e-9) {
            self.triangle(chart, [a, b, c]);
            self.triangle(chart, [a, c, d]);
        } else {
            self.triangle(chart, [a, b, d]);
            self.triangle(chart, [b, c, d]);
        }
    }

    /// Adds another shape's charts, turned and moved.
    pub(crate) fn append(&mut self, other: ChartedMesh, rotation: DQuat, translation: DVec3) {
        let charts = self.charts;
        self.charts += other.charts;
        self.triangles
            .extend(other.triangles.into_iter().map(|triangle| Triangle {
                corners: triangle.corners.map(|corner| Corner {
                    position: translation + rotation * corner.position,
                    sheet: corner.sheet,
                    normal: corner.normal.map(|normal| rotation * normal),
                }),
                chart: charts + triangle.chart,
            }));
    }

    /// Adds a chart from a grid of corners: rows follow each other to the left of their own direction.
    pub(crate) fn grid(&mut self, rows: &[Vec<Corner>]) {
        let chart = self.begin_chart();
        for pair in rows.windows(2) {
            for i in 1..pair[0].len() {
                self.quad(chart, [pair[0][i - 1], pair[0][i], pair[1][i], pair[1][i - 1]]);
            }
        }
    }
}

/// A named piece of a model.
#[derive(Clone, Debug)]
pub(crate) struct ModelPart {
    /// Node name.
    pub(crate) name: String,
    /// Position of its origin in the model, in meters.
    pub(crate) translation: DVec3,
    /// Rotation about its origin.
    pub(crate) rotation: DQuat,
    /// Index of its material in the model.
    pub(crate) material: usize,
    /// Its triangles.
    pub(crate) shape: ChartedMesh,
    /// Faces that meet at less than this angle, in degrees, are shaded as one.
    pub(crate) smooth_below: f64,
}

impl ModelPart {
    /// Creates a part at the model's origin, of its first material, that is smooth up to 50 degrees.
    pub(crate) fn new(name: impl Into<String>, shape: ChartedMesh) -> ModelPart {
        ModelPart {
            name: name.into(),
            translation: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            material: 0,
            shape,
            smooth_below: 50.0,
        }
    }
}

/// Creates a part of a material at a place.
pub(crate) fn part(
    name: impl Into<String>,
    material: usize,
    translation: DVec3,
    rotation: DQuat,
    shape: ChartedMesh,
) -> ModelPart {
    ModelPart {
        translation,
        rotation,
        material,
        ..ModelPart::new(name, shape)
    }
}

/// Same place, whatever the last bits say: a tenth of a micrometer.
pub(crate) fn place_key(position: DVec3) -> [i64; 3] {
    (position * 1e7).round().to_array().map(|value| value as i64)
}

/// One shading normal a corner: faces weighted by area and angle, so that large flat faces stay flat and the narrow
/// rounded edge between them takes the whole turn.
pub(crate) fn corner_normals(part: &ModelPart) -> Vec<[DVec3; 3]> {
    let triangles = &part.shape.triangles;
    let mut faces_at: BTreeMap<[i64; 3], Vec<(usize, f64)>> = BTreeMap::new();
    for (index, triangle) in triangles.iter().enumerate() {
        let corners = triangle.corners.map(|corner| corner.position);
        for i in 0..3 {
            let (one, other) = (corners[(i + 1) % 3] - corners[i], corners[(i + 2) % 3] - corners[i]);
            faces_at
                .entry(place_key(corners[i]))
                .or_default()
                .push((index, one.angle_between(other)));
        }
    }
    let least_cosine = part.smooth_below.to_radians().cos();
    triangles
        .iter()
        .map(|triangle| {
            let own = triangle.cross().normalize_or_zero();
            triangle.corners.map(|corner| {
                let sum: DVec3 = faces_at[&place_key(corner.position)]
                    .iter()
                    .map(|&(index, angle)| (triangles[index].cross(), angle))
                    .filter(|(cross, _)| cross.normalize_or_zero().dot(own) >= least_cosine)
                    .map(|(cross, angle)| cross * angle)
                    .sum();
                corner.normal.unwrap_or(sum.normalize_or(own))
            })
        })
        .collect()
}
