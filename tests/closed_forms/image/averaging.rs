//! Values of texels that cover many pixels, few pixels or a part of one.

use super::*;

/// Returns cells of light and dark that become finer towards one corner, which shows aliasing if too few pixels are read.
fn cells(side: u32) -> Vec<u8> {
    let code = |x: u32, y: u32| {
        let wave = (f64::from(x * x) / f64::from(side) * 1.3).sin() * (f64::from(y * y) / f64::from(side)).cos();
        if wave > 0.2 { 230 } else { 20 }
    };
    (0..side * side).map(|at| code(at % side, at / side)).collect()
}

/// Returns the mean of a picture over the area of each texel, weighted by the covered share of each pixel.
fn mean(codes: &[u8], picture: u32, texels: u32, [x, y]: [u32; 2]) -> f64 {
    let side = f64::from(picture) / f64::from(texels);
    let [mut sum, mut weights] = [0.0; 2];
    let share = |at: u32, pixel: u32| {
        let [low, high] = [f64::from(at) * side, f64::from(at + 1) * side];
        (f64::from(pixel + 1).min(high) - f64::from(pixel).max(low)).max(0.0)
    };
    let span = |at: u32| (f64::from(at) * side) as u32..((f64::from(at + 1) * side).ceil() as u32).min(picture);
    for row in span(y) {
        for column in span(x) {
            let weight = share(x, column) * share(y, row);
            sum += weight * f64::from(codes[(row * picture + column) as usize]) / 255.0;
            weights += weight;
        }
    }
    sum / weights
}

#[test]
fn a_texel_has_the_mean_of_the_area_that_it_covers() {
    // The pixels of a texel that covers a power of two are averaged exactly, up to rounding of single precision; else taps blur by
    // a part of a pixel.
    for (picture, texels, most) in [(1024, 128, 1e-6), (256, 256, 1e-6), (512, 64, 1e-6), (600, 100, 0.02)] {
        let folder = Folder::new();
        let codes = cells(picture);
        let file = folder.write("cells.png", png(picture, 1, false, &codes));
        let mut on_mesh = on_square(&json!({ "file": file }), texels);
        let values = on_mesh.evaluate("image.mask").component("mask");
        let (mut squares, mut count) = (0.0, 0.0);
        for (index, pixel) in pixels(&on_mesh, texels) {
            let at = [pixel as u32 % texels, pixel as u32 / texels];
            squares += (f64::from(values[index]) - mean(&codes, picture, texels, at)).powi(2);
            count += 1.0;
        }
        let error = (squares / f64::max(count, 1.0)).sqrt();
        assert!(error < most, "{picture} to {texels}: {error}");
    }
}

#[test]
fn a_long_or_slanted_texel_is_read_along_both_its_sides() {
    // The stripes are one pixel wide, so a texel over several of them is gray.
    let folder = Folder::new();
    let stripes: Vec<u8> = (0..64 * 64).map(|at| if at % 2 == 0 { 255 } else { 0 }).collect();
    let file = folder.write("stripes.png", png(64, 1, false, &stripes));
    for (tiles, rotate) in [([16.0, 1.0], 0.0), ([9.0, 9.0], 45.0), ([14.0, 2.0], 30.0)] {
        let params = json!({ "file": file, "tiles": tiles, "rotate": rotate });
        let mut on_mesh = on_square(&params, 64);
        let values = on_mesh.evaluate("image.mask").component("mask");
        for (index, _) in on_mesh.owned() {
            // A texel that does not cover a whole number of stripes is off by less than one stripe of its length.
            let value = values[index];
            assert!((value - 0.5).abs() < 0.07, "{tiles:?} turned by {rotate}: {value}");
        }
    }
}

#[test]
fn many_repeats_are_as_sharp_as_one() {
    // A texel of each tile lies on the center of each pixel, over and over.
    let folder = Folder::new();
    let codes: Vec<u8> = (0..16).map(|at| 16 * at).collect();
    let file = folder.write("few.png", png(4, 1, false, &codes));
    let mut on_mesh = on_square(&json!({ "file": file, "tiles": [64, 64] }), 256);
    let values = on_mesh.evaluate("image.mask").component("mask");
    for (index, pixel) in pixels(&on_mesh, 256) {
        let code = codes[pixel / 256 % 4 * 4 + pixel % 4];
        // A driver may round the share of 255 either way.
        let apart = (values[index] - f32::from(code) / 255.0).abs();
        assert!(apart <= f32::EPSILON, "texel {pixel}: {apart}");
    }
}

#[test]
fn clear_pixels_give_no_color_to_the_opaque_ones_beside_them() {
    let folder = Folder::new();
    // Red columns between clear black ones, four pixels wide, so that texels see both.
    let codes: Vec<u8> = (0..SIDE * SIDE)
        .flat_map(|at| {
            if (at % SIDE / 4).is_multiple_of(2) {
                [255, 0, 0, 255]
            } else {
                [0, 0, 0, 0]
            }
        })
        .collect();
    let file = folder.write("stripes.png", png(SIDE, 4, true, &codes));
    let made = MeshFile::new(vec![square()]).write();
    let red = |params: &Value, size: u32| {
        let mut on_mesh = OnMesh::new(&graph(params), made.path(), size);
        let [color, alpha] = [("image.color", "color.r"), ("image.alpha", "mask")]
            .map(|(port, component)| on_mesh.evaluate(port).component(component).to_vec());
        let seen: Vec<(f32, f32)> = on_mesh.owned().map(|(index, _)| (color[index], alpha[index])).collect();
        seen
    };
    for params in [
        json!({}),
        json!({ "rotate": 30 }),
        json!({ "tiles": [3, 3] }),
        json!({ "tiling": "random" }),
        json!({ "projection": "triplanar", "size": 0.7, "rotate": 20 }),
        json!({ "projection": "decal", "size": 0.9, "rotate": 10 }),
    ] {
        let mut params = params;
        params["file"] = json!(file);
        for size in [24, 50, 200] {
            let partly = red(&params, size)
                .into_iter()
                .filter(|(_, alpha)| (0.01..0.99).contains(alpha));
            let colors: Vec<f32> = partly.map(|(color, _)| color).collect();
            assert!(colors.len() > 20, "{params} at {size} has {} soft texels", colors.len());
            // Colors are stored as half floats.
            let least = colors.iter().copied().fold(f32::INFINITY, f32::min);
            assert!(least > 0.998, "{params} at {size}: red is {least}");
        }
    }
    // A texel over both kinds of columns has the plain mean where alpha holds other data.
    let data = red(&json!({ "file": file, "alpha_is": "data", "tiles": [4, 4] }), 16);
    assert!(data.iter().all(|(color, _)| (color - 0.5).abs() < 0.01), "{data:?}");
}
