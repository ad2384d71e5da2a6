//! Parameters of `source/image`.

use sabi_nodes::kind::Param;

/// Declares all parameters of the kind.
pub(super) fn params() -> Vec<Param> {
    [projection_params(), cell_params(), tiling_params(), decal_params()].concat()
}

/// Parameters of the projection.
fn projection_params() -> Vec<Param> {
    vec![
        Param::file(
            "file",
            "Image file: PNG, JPEG, WebP, TGA, BMP, HDR or OpenEXR. A relative path starts from the folder of the \
             graph file.",
        ),
        Param::text(
            "layer",
            "",
            "Layer of an OpenEXR file with several, such as diffuse; the picture itself where it is empty.",
        ),
        Param::choice(
            "color_space",
            &["auto", "srgb", "linear"],
            "Color space of the file. With auto, the color is read as the file declares, else as sRGB, or as linear in \
             files of floating-point numbers, and the mask is read as linear. Alpha and slope are always linear.",
        ),
        Param::choice(
            "alpha_is",
            &["opacity", "data"],
            "Meaning of the file's alpha for its color. As opacity, clear pixels give no color to the averages of their neighbors, so \
             that borders of holes have no fringes; as data, such as smoothness, it is left alone.",
        ),
        Param::choice(
            "projection",
            &["uv", "triplanar", "decal"],
            "Placement of the image: by the model's own texture coordinates (uv), from three sides along the model's \
             axes (triplanar), or from one side (decal).",
        ),
        Param::length(
            "size",
            0.5,
            "Width of one tile for triplanar, or of the decal; pixels stay square.",
        )
        .within(1e-4, 100.0)
        .with_slider(0.01, 2.0),
        Param::pair(
            "tiles",
            [1.0, 1.0],
            "Number of repeats across and down the texture coordinates, for uv.",
        )
        .within(0.001, 1000.0)
        .with_slider(1.0, 16.0),
        Param::angle("rotate", 0.0, "Rotates the image counter-clockwise.")
            .within(-360.0, 360.0)
            .with_slider(-180.0, 180.0),
        Param::pair("offset", [0.0, 0.0], "Moves the image to the right and up, in tiles.").within(-1000.0, 1000.0),
        Param::number(
            "sharpness",
            8.0,
            "Sharpness of the blend between the three sides, for triplanar.",
        )
        .within(1.0, 64.0),
        Param::choice(
            "normal_y",
            &["up", "down"],
            "Direction of green in a normal map: up as in OpenGL and glTF, down as in DirectX.",
        ),
    ]
}

/// Parameters of a file with several pictures.
fn cell_params() -> Vec<Param> {
    let count = |name: &str, doc: &str| Param::number(name, 1.0, doc).within(1.0, 64.0).with_slider(1.0, 8.0);
    vec![
        count(
            "columns",
            "Number of pictures side by side in the file, all of one size. Each place shows one of them, which the input Cell \
             chooses; random tiling is off then.",
        ),
        count(
            "rows",
            "Number of pictures below one another in the file, the first ones at the top.",
        ),
    ]
}

/// Parameters of the tiling.
fn tiling_params() -> Vec<Param> {
    vec![
        Param::choice(
            "tiling",
            &["repeat", "random"],
            "How the image goes on beyond its borders, for uv and triplanar: as it is (repeat), or as overlapping patches of \
             random parts of it, so that no repetition is visible (random). Images with equal seeds stay aligned.",
        ),
        Param::angle(
            "turn",
            180.0,
            "Largest angle by which patches are rotated, for random tiling; 0 for wood, fabric and other images with a \
             direction.",
        )
        .within(0.0, 180.0),
        Param::seed(
            "seed",
            "Number that chooses one of many arrangements of patches, for random tiling.",
        ),
    ]
}

/// Parameters that place a decal.
fn decal_params() -> Vec<Param> {
    vec![
        // The input of this name has another meaning.
        Param::lengths("position", [0.0; 3], "Center of the decal, in model space.").labeled("Center"),
        Param::vector(
            "toward",
            [0.0, 0.0, 1.0],
            "Direction that the decal faces, in model space.",
        ),
        Param::vector(
            "up",
            [0.0, 1.0, 0.0],
            "Direction from the bottom to the top of the decal, in model space.",
        ),
        Param::length(
            "depth",
            0.25,
            "Distance that the decal reaches in front of its center and behind it.",
        )
        .within(1e-4, 100.0),
        Param::angle(
            "facing",
            80.0,
            "Largest angle between the surface normal and Toward; the decal fades out over the last ten degrees.",
        )
        .within(10.0, 180.0),
    ]
}
