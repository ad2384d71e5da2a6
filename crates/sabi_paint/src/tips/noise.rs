//! Random numbers and noise that are the same on every machine.

use glam::{DVec2, DVec3};

/// Random number of a cell, 0 to 1.
pub(crate) fn random(seed: u32, cell: [i32; 3]) -> f64 {
    f64::from(pcg(seed, cell)[0]) / f64::from(u32::MAX)
}

/// Three independent random numbers of a cell, each 0 to 1.
pub(super) fn numbers(seed: u32, cell: [i32; 3]) -> [f64; 3] {
    let [x, y, z] = cell.map(|number| number as u32);
    let place = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77).rotate_left(7) ^ z.wrapping_mul(0xc2b2_ae3d);
    let first = mixed(place ^ seed);
    let second = mixed(first ^ 0x27d4_eb2f);
    let half = |value: u32| f64::from(value & 0xffff) * (1.0 / 65536.0);
    [half(first), half(first >> 16), unit(second)]
}

/// Random place in a cell of space, 0 to 1 along each axis.
pub(super) fn place_in(seed: u32, cell: DVec3) -> DVec3 {
    let [x, y, z] = cell.to_array().map(|number| number as i32 as u32);
    let place = x
        .wrapping_mul(0x9e37_79b1)
        .wrapping_add(y.wrapping_mul(0x85eb_ca77))
        .wrapping_add(z.wrapping_mul(0xc2b2_ae3d));
    let hash = mixed(place ^ seed.wrapping_mul(0x27d4_eb2f));
    let part = |shift: u32| f64::from(hash >> shift & 1023) * (1.0 / 1024.0);
    DVec3::new(part(0), part(10), part(20))
}

/// Hash of a cell (PCG in three dimensions: Jarzynski and Olano, "Hash functions for GPU rendering", 2020).
fn pcg(seed: u32, cell: [i32; 3]) -> [u32; 3] {
    let mut v = cell.map(|number| {
        (number as u32)
            .wrapping_add(seed)
            .wrapping_mul(1_664_525)
            .wrapping_add(1_013_904_223)
    });
    for _ in 0..2 {
        v[0] = v[0].wrapping_add(v[1].wrapping_mul(v[2]));
        v[1] = v[1].wrapping_add(v[2].wrapping_mul(v[0]));
        v[2] = v[2].wrapping_add(v[0].wrapping_mul(v[1]));
        v = v.map(|number| number ^ (number >> 16));
    }
    v
}

/// Hash of a number (Wellons, "Prospecting for hash functions", 2018).
fn mixed(mut value: u32) -> u32 {
    value = (value ^ (value >> 16)).wrapping_mul(0x21f0_aaad);
    value = (value ^ (value >> 15)).wrapping_mul(0x735a_2d97);
    value ^ (value >> 15)
}

fn unit(value: u32) -> f64 {
    f64::from(value) * (1.0 / 4_294_967_296.0)
}

/// One seed for a stamp of a stroke.
pub(super) fn seed_of([stroke, stamp]: [u32; 2]) -> u32 {
    mixed(stroke ^ mixed(stamp.wrapping_add(0x9e37_79b9)))
}

/// Random numbers in a row.
pub(super) struct RandomSequence {
    seed: u32,
    thrown: u32,
}

impl RandomSequence {
    pub(super) fn new(seeds: [u32; 2]) -> RandomSequence {
        RandomSequence {
            seed: seed_of(seeds),
            thrown: 0,
        }
    }

    /// Next number, 0 to 1.
    pub(super) fn unit(&mut self) -> f64 {
        self.thrown += 1;
        unit(mixed(self.seed.wrapping_add(self.thrown.wrapping_mul(0x9e37_79b9))))
    }

    /// Next number between two bounds.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Next unit vector.
    pub(super) fn direction(&mut self) -> DVec2 {
        toward(std::f64::consts::TAU * self.unit())
    }

    /// Next place in a disk around the origin, evenly spread.
    pub(super) fn in_disk(&mut self, radius: f64) -> DVec2 {
        let away = radius * self.unit().sqrt();
        away * self.direction()
    }

    /// Offset that gives each stamp its own part of an endless noise.
    pub(super) fn offset(&mut self) -> DVec2 {
        DVec2::new(self.between(-512.0, 512.0), self.between(-512.0, 512.0))
    }
}

/// Unit vector at an angle, radians.
pub(super) fn toward(angle: f64) -> DVec2 {
    DVec2::new(angle.cos(), angle.sin())
}

/// 0 below a band of half the width `half` around `middle`, 1 above it, and smooth in between.
pub(super) fn smooth_step(value: f64, middle: f64, half: f64) -> f64 {
    let t = ((value - middle + half) / (2.0 * half)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Space turned so that no lattice of a noise lies along the walls of a model.
pub(super) fn turned(place: DVec3) -> DVec3 {
    DVec3::new(
        0.36 * place.x + 0.48 * place.y - 0.8 * place.z,
        -0.8 * place.x + 0.6 * place.y,
        0.48 * place.x + 0.64 * place.y + 0.6 * place.z,
    )
}

/// Noise around 0.5 between 0 and 1 whose grains are about 1 wide (Perlin, "Improving noise", 2002, with hashed gradients).
pub(super) fn noise_3(place: DVec3, seed: u32) -> f64 {
    let place = turned(place);
    let cell = place.floor();
    let near = place - cell;
    let far = near - 1.0;
    let t = near * near * (3.0 - 2.0 * near);
    let [x, y, z] = [cell.x, cell.y, cell.z].map(|number| number as i32 as u32);
    let xs = [x.wrapping_mul(0x9e37_79b1), x.wrapping_add(1).wrapping_mul(0x9e37_79b1)];
    let ys = [y.wrapping_mul(0x85eb_ca77), y.wrapping_add(1).wrapping_mul(0x85eb_ca77)];
    let zs = [z.wrapping_mul(0xc2b2_ae3d), z.wrapping_add(1).wrapping_mul(0xc2b2_ae3d)];
    let [dx, dy, dz] = [[near.x, far.x], [near.y, far.y], [near.z, far.z]];
    let salt = seed.wrapping_mul(0x27d4_eb2f);
    let corner = |i: usize, j: usize, k: usize| {
        let hash = mixed(xs[i].wrapping_add(ys[j]).wrapping_add(zs[k]) ^ salt);
        let part = |shift: u32| f64::from((hash >> shift & 1023) as i32 - 512);
        part(0) * dx[i] + part(10) * dy[j] + part(20) * dz[k]
    };
    let mix = |t: f64, a: f64, b: f64| a + t * (b - a);
    let row = |j: usize, k: usize| mix(t.x, corner(0, j, k), corner(1, j, k));
    let value = mix(t.z, mix(t.y, row(0, 0), row(1, 0)), mix(t.y, row(0, 1), row(1, 1)));
    (0.5 + value * (1.1 / 512.0)).clamp(0.0, 1.0)
}

/// As [`noise_3`], in the plane.
pub(super) fn noise_2(place: DVec2, seed: u32) -> f64 {
    let place = DVec2::new(0.8 * place.x - 0.6 * place.y, 0.6 * place.x + 0.8 * place.y);
    stretched_noise(place, seed)
}

/// As [`noise_2`], with its lattice along the axes: for noise that is stretched along one of them.
pub(super) fn stretched_noise(place: DVec2, seed: u32) -> f64 {
    let cell = place.floor();
    let near = place - cell;
    let far = near - 1.0;
    let t = near * near * (3.0 - 2.0 * near);
    let [x, y] = [cell.x, cell.y].map(|number| number as i32 as u32);
    let [dx, dy] = [[near.x, far.x], [near.y, far.y]];
    let salt = seed.wrapping_mul(0x27d4_eb2f);
    let corner = |i: usize, j: usize| {
        let at_x = x.wrapping_add(i as u32).wrapping_mul(0x9e37_79b1);
        let at_y = y.wrapping_add(j as u32).wrapping_mul(0x85eb_ca77);
        let hash = mixed(at_x.wrapping_add(at_y) ^ salt);
        let part = |shift: u32| f64::from((hash >> shift & 0xffff) as i32 - 0x8000);
        part(0) * dx[i] + part(16) * dy[j]
    };
    let mix = |t: f64, a: f64, b: f64| a + t * (b - a);
    let value = mix(
        t.y,
        mix(t.x, corner(0, 0), corner(1, 0)),
        mix(t.x, corner(0, 1), corner(1, 1)),
    );
    (0.5 + value * (1.1 / 32768.0)).clamp(0.0, 1.0)
}

/// Cells of the 2 by 2 block around a place, given in cells. A thing in a cell is seen wholly if it reaches no farther than half
/// a cell beyond it.
pub(super) fn block(place: DVec2) -> [DVec2; 4] {
    let first = (place - 0.5).floor();
    [first, first + DVec2::X, first + DVec2::Y, first + DVec2::ONE]
}
