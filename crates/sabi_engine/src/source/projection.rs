//! Projection of a picture onto a surface: by texture coordinates, triplanar, or as a decal.

use glam::DVec3;
use sabi_plan::{NoSuchValue, SourceValues};

use super::read_position::ReadPosition;
use super::sampler::Footprint;
use super::texels::{Frame, SourceSurface, SurfacePoint};

/// Angle over which a decal fades out where the surface turns away, radians.
const FACING_FADE: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// Fraction of a decal's depth over which it fades out.
const DEPTH_FADE: f64 = 0.1;

/// Projection of a picture onto a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    mode: Mode,
    /// Cosine and sine of the picture's rotation, counter-clockwise as seen.
    turn: [f64; 2],
    /// Offset to the right and up, in tiles.
    offset: [f64; 2],
    /// Height of a tile divided by its width.
    aspect: f64,
    cells: Cells,
}

/// Columns and rows of equal pictures in one file, of which a single one is seen.
#[derive(Clone, Copy, Debug)]
struct Cells {
    sides: [f64; 2],
    /// Half of a pixel of the file, in texture coordinates.
    half_pixel: [f64; 2],
}

#[derive(Clone, Copy, Debug)]
enum Mode {
    Uv { tiles: [f64; 2] },
    Triplanar { size: f64, sharpness: f64 },
    Decal(Decal),
}

/// Decal on the surface. Lengths and positions in working units.
#[derive(Clone, Copy, Debug)]
struct Decal {
    size: f64,
    middle: DVec3,
    plane: Plane,
    toward: DVec3,
    depth: f64,
    facing: f64,
}

/// Unit vectors in model space to the right and the top of a picture.
#[derive(Clone, Copy, Debug)]
struct Plane {
    right: DVec3,
    up: DVec3,
}

/// Picture at a point of the surface, as seen from one direction.
pub(crate) struct View {
    pub(crate) footprint: Footprint,
    /// Weight in the result; the weights of all views of a point sum to 1.
    pub(crate) weight: f32,
    /// Coverage: 1, or less where a decal ends.
    pub(crate) cover: f32,
    axes: Axes,
}

/// Directions of a picture's x and y on the surface.
enum Axes {
    /// In the tangent frame of the model.
    Tangents,
    /// In this plane.
    Plane(Plane),
}

/// Normalizes a vector, or returns another one where it is too short.
fn unit(v: DVec3, otherwise: DVec3) -> DVec3 {
    let length = v.length();
    if length > 1e-12 { v / length } else { otherwise }
}

impl Cells {
    /// Returns the footprint on the file of one on a single picture, which does not reach over its borders.
    fn footprint(&self, own: &Footprint, cell: f64) -> Footprint {
        let [columns, rows] = self.sides;
        let number = (cell.clamp(0.0, 1.0) * columns * rows)
            .floor()
            .min(columns * rows - 1.0);
        let place = [number % columns, (number / columns).floor()];
        let steps = own.steps.map(|[u, v]| [u / columns, v / rows]);
        let uv = [0, 1].map(|axis| {
            let x = own.uv[axis];
            let inside = if (0.0..=1.0).contains(&x) { x } else { x - x.floor() };
            let reach = 0.5 * (steps[0][axis].abs() + steps[1][axis].abs()) + self.half_pixel[axis];
            let margin = (reach * self.sides[axis]).min(0.5);
            (place[axis] + inside.clamp(margin, 1.0 - margin)) / self.sides[axis]
        });
        Footprint { uv, steps }
    }
}

impl Projection {
    /// Reads the parameters of `source/image`; `pixels` is the size of the picture.
    pub(crate) fn new(values: &SourceValues, pixels: [u32; 2]) -> Result<Projection, NoSuchValue> {
        let size = f64::from(values.number("size")?);
        let (sin, cos) = f64::from(values.number("rotate")?).sin_cos();
        let mode = match values.index("projection")? {
            0 => Mode::Uv {
                tiles: values.numbers::<2>("tiles")?.map(f64::from),
            },
            1 => Mode::Triplanar {
                size,
                sharpness: f64::from(values.number("sharpness")?),
            },
            _ => Mode::Decal(Decal::new(values, size)?),
        };
        let sides = [values.number("columns")?, values.number("rows")?];
        let cells = Cells {
            sides: sides.map(|side| f64::from(side).round().max(1.0)),
            half_pixel: pixels.map(|side| 0.5 / f64::from(side.max(1))),
        };
        Ok(Projection {
            mode,
            turn: [cos, sin],
            offset: values.numbers::<2>("offset")?.map(f64::from),
            aspect: f64::from(pixels[1]) * cells.sides[0] / (f64::from(pixels[0].max(1)) * cells.sides[1]),
            cells,
        })
    }

    /// Returns whether the picture repeats.
    pub(crate) fn repeats(&self) -> bool {
        !matches!(self.mode, Mode::Decal(_))
    }

    /// Height of the picture divided by its width.
    pub(crate) fn aspect(&self) -> f64 {
        self.aspect
    }

    /// Returns whether the file holds several pictures.
    pub(crate) fn has_cells(&self) -> bool {
        self.cells.sides != [1.0; 2]
    }

    /// Returns the views of the picture at a point, or at the position that is read in its place. `cell` chooses one of several
    /// pictures, from 0 for the first to 1 for the last one; without it the z of texture coordinates that are read does.
    pub(crate) fn views_of_cell(
        &self,
        surface: &SourceSurface<'_>,
        point: &SurfacePoint,
        read: Option<ReadPosition>,
        cell: Option<f64>,
    ) -> [Option<View>; 3] {
        let mut views = self.views(surface, point, read);
        if self.has_cells() {
            let of_uv = read
                .filter(|_| matches!(self.mode, Mode::Uv { .. }))
                .map(|read| read.at.z);
            let cell = cell.or(of_uv).unwrap_or(0.0); // The first one where nothing chooses.
            for view in views.iter_mut().flatten() {
                view.footprint = self.cells.footprint(&view.footprint, cell);
            }
        }
        views
    }

    /// Returns the views of the picture at a point, or at the position that is read in its place.
    fn views(
        &self,
        surface: &SourceSurface<'_>,
        point: &SurfacePoint,
        read: Option<ReadPosition>,
    ) -> [Option<View>; 3] {
        let place = || read.unwrap_or_else(|| surface_position(surface, point));
        match (&self.mode, read) {
            (Mode::Uv { tiles }, None) => [Some(self.uv_view(*tiles, surface, point)), None, None],
            (Mode::Uv { tiles }, Some(read)) => [Some(self.read_view(*tiles, surface, point, &read)), None, None],
            (Mode::Triplanar { size, sharpness }, _) => {
                self.triplanar_views([*size, *sharpness], surface, point, &place())
            }
            (Mode::Decal(decal), _) => [Some(self.decal_view(decal, surface, point, &place())), None, None],
        }
    }

    /// Computes the surface gradient in model space of a normal of the picture in a view.
    pub(crate) fn slope(&self, view: &View, frame: &Frame, normal: [f32; 3]) -> [f32; 3] {
        let [cos, sin] = self.turn;
        let [x, y, z] = normal.map(f64::from);
        match view.axes {
            Axes::Tangents => frame.slope([(cos * x - sin * y) as f32, (sin * x + cos * y) as f32, z as f32]),
            Axes::Plane(plane) => {
                // The gradient in space of a height that is constant along the projection, and its part in the surface
                // (Mikkelsen 2020, "Surface Gradient-Based Bump Mapping Framework").
                let steep = z.max(1e-3 * (x * x + y * y + z * z).sqrt()).max(1e-30);
                let plane = self.turned(plane);
                let gradient = -(x * plane.right + y * plane.up) / steep;
                let up = unit(frame.normal, DVec3::ZERO);
                (gradient - gradient.dot(up) * up).as_vec3().to_array()
            }
        }
    }

    fn uv_view(&self, tiles: [f64; 2], surface: &SourceSurface<'_>, point: &SurfacePoint) -> View {
        let texel = 1.0 / f64::from(surface.atlas.size);
        View {
            footprint: self.tiled(tiles, point.uv, [[texel, 0.0], [0.0, texel]]),
            weight: 1.0,
            cover: 1.0,
            axes: Axes::Tangents,
        }
    }

    /// Returns the view at texture coordinates that are read, with y upward.
    fn read_view(
        &self,
        tiles: [f64; 2],
        surface: &SourceSurface<'_>,
        point: &SurfacePoint,
        read: &ReadPosition,
    ) -> View {
        let steps = read.steps.map(|step| [step.x, -step.y]);
        View {
            footprint: self.tiled(tiles, [read.at.x, 1.0 - read.at.y], steps),
            weight: 1.0,
            cover: 1.0,
            axes: Axes::of_gradients(surface.atlas_sides(point), read),
        }
    }

    /// Returns the footprint of texture coordinates on the repeated picture.
    fn tiled(&self, tiles: [f64; 2], uv: [f64; 2], steps: [[f64; 2]; 2]) -> Footprint {
        // v points down, angles are counter-clockwise.
        let turned = |u: f64, v: f64| {
            let [x, y] = [u * tiles[0], -v * tiles[1]];
            let [cos, sin] = self.turn;
            [cos * x + sin * y, sin * x - cos * y]
        };
        let [u, v] = turned(uv[0] - 0.5, uv[1] - 0.5);
        Footprint {
            uv: [u + 0.5 * tiles[0] - self.offset[0], v + 0.5 * tiles[1] + self.offset[1]],
            steps: steps.map(|[u, v]| turned(u, v)),
        }
    }

    fn triplanar_views(
        &self,
        [size, sharpness]: [f64; 2],
        surface: &SourceSurface<'_>,
        point: &SurfacePoint,
        place: &ReadPosition,
    ) -> [Option<View>; 3] {
        let normal = unit(surface.frame(point).normal, DVec3::Y);
        let weights = normal.to_array().map(|x| x.abs().powf(sharpness));
        let sum: f64 = weights.iter().sum();
        std::array::from_fn(|axis| {
            let weight = weights[axis] / sum.max(1e-30);
            // The picture faces outward on both sides; at the change of sides its weight is 0.
            let side = if normal[axis] < 0.0 { -1.0 } else { 1.0 };
            let plane = match axis {
                0 => Plane {
                    right: DVec3::new(0.0, 0.0, -side),
                    up: DVec3::Y,
                },
                1 => Plane {
                    right: DVec3::new(side, 0.0, 0.0),
                    up: DVec3::NEG_Z,
                },
                _ => Plane {
                    right: DVec3::new(side, 0.0, 0.0),
                    up: DVec3::Y,
                },
            };
            (weight > 1e-6).then(|| View {
                footprint: self.on_plane(plane, DVec3::ZERO, size, place),
                weight: weight as f32,
                cover: 1.0,
                axes: Axes::Plane(plane),
            })
        })
    }

    fn decal_view(
        &self,
        decal: &Decal,
        surface: &SourceSurface<'_>,
        point: &SurfacePoint,
        place: &ReadPosition,
    ) -> View {
        let footprint = self.on_plane(decal.plane, decal.middle, decal.size, place);
        let share = |x: f64| x.clamp(0.0, 1.0);
        // Part of the texel that lies on the picture, estimated from the extent of the texel.
        let inside = |axis: usize| {
            let extent = footprint.steps[0][axis].abs() + footprint.steps[1][axis].abs();
            let at = footprint.uv[axis];
            share(0.5 + at.min(1.0 - at) / extent.max(1e-9))
        };
        let away = (place.at - decal.middle).dot(decal.toward).abs();
        let deep = share((decal.depth - away) / (DEPTH_FADE * decal.depth).max(1e-9));
        let normal = unit(surface.frame(point).normal, decal.toward);
        let angle = normal.dot(decal.toward).clamp(-1.0, 1.0).acos();
        let faces = share((decal.facing - angle) / FACING_FADE);
        View {
            weight: 1.0,
            cover: (inside(0) * inside(1) * deep * faces) as f32,
            axes: Axes::Plane(decal.plane),
            footprint,
        }
    }

    fn turned(&self, plane: Plane) -> Plane {
        let [cos, sin] = self.turn;
        Plane {
            right: cos * plane.right + sin * plane.up,
            up: cos * plane.up - sin * plane.right,
        }
    }

    /// Returns the footprint of a texel on a picture with its center at `middle`.
    fn on_plane(&self, plane: Plane, middle: DVec3, size: f64, place: &ReadPosition) -> Footprint {
        let plane = self.turned(plane);
        let seen = |v: DVec3| [v.dot(plane.right) / size, -v.dot(plane.up) / (size * self.aspect)];
        let [u, v] = seen(place.at - middle);
        Footprint {
            uv: [u + 0.5 - self.offset[0], v + 0.5 + self.offset[1]],
            steps: place.steps.map(seen),
        }
    }
}

/// Position of the surface itself.
fn surface_position(surface: &SourceSurface<'_>, point: &SurfacePoint) -> ReadPosition {
    ReadPosition {
        at: surface.position(point),
        steps: surface.texel_sides(point),
    }
}

impl Axes {
    /// Returns the directions in which the x and the y of a position that is read grow on the surface, given the sides of a
    /// texel; the tangents where one of them stands still.
    fn of_gradients(sides: [DVec3; 2], read: &ReadPosition) -> Axes {
        let [along, across] = sides;
        let metric = [along.dot(along), along.dot(across), across.dot(across)];
        let area = (metric[0] * metric[2] - metric[1] * metric[1]).max(1e-30);
        // The tangent vector whose products with the sides are the changes along them, at unit length.
        let gradient = |axis: usize| {
            let change = read.steps.map(|step| step[axis]);
            let of_along = metric[2] * change[0] - metric[1] * change[1];
            let of_across = metric[0] * change[1] - metric[1] * change[0];
            unit((of_along * along + of_across * across) / area, DVec3::ZERO)
        };
        let plane = Plane {
            right: gradient(0),
            up: gradient(1),
        };
        if plane.right == DVec3::ZERO || plane.up == DVec3::ZERO {
            return Axes::Tangents;
        }
        Axes::Plane(plane)
    }
}

impl Decal {
    fn new(values: &SourceValues, size: f64) -> Result<Decal, NoSuchValue> {
        let vector = |name: &str| Ok::<_, NoSuchValue>(DVec3::from(values.numbers::<3>(name)?.map(f64::from)));
        let toward = unit(vector("toward")?, DVec3::Z);
        // Where `up` is parallel to `toward`, another axis replaces it.
        let otherwise = if toward.y.abs() < 0.9 { DVec3::Y } else { DVec3::NEG_Z };
        let right = vector("up")?.cross(toward);
        let right = if right.length_squared() > 1e-12 {
            right
        } else {
            otherwise.cross(toward)
        };
        let right = unit(right, DVec3::X);
        Ok(Decal {
            size,
            middle: vector("position")?,
            plane: Plane {
                right,
                up: toward.cross(right),
            },
            toward,
            depth: f64::from(values.number("depth")?),
            facing: f64::from(values.number("facing")?),
        })
    }
}
