//! Everything in this crate that is also declared in WGSL files.

use sabi_nodes::link::{Mirror, MirrorsWgsl};

use crate::edges::Line;
use crate::environment::prefilter::{CubePass, GROUP};
use crate::frame::{FrameUniforms, LightRow};
use crate::model::Vertex;
use crate::pipelines::{Backdrop, MAP_BITS, SHOWN_COLOR, SHOWN_VECTOR, Switches, Transform};
use crate::renderer::DisplayUniforms;
use crate::renderer::bloom::BloomPass;
use crate::renderer::bound_scene::{BoundMaterial, LineStyle};
use crate::renderer::passes::Caster;
use crate::scene::Mode;
use crate::upload::CHART_BITS;

/// Returns the structs, constants, overrides and workgroup sizes that are declared here and in WGSL. A test compares them
/// with all linked modules.
pub fn mirrors() -> Vec<Mirror> {
    let mut mirrors = vec![
        BloomPass::mirror(),
        Caster::mirror(),
        CubePass::mirror(),
        DisplayUniforms::mirror(),
        FrameUniforms::mirror(),
        LightRow::mirror(),
        Line::mirror(),
        LineStyle::mirror(),
        BoundMaterial::mirror(),
        Vertex::mirror(),
        Mirror::constant("CHART_BITS", "view/maps", "CHART_BITS", [CHART_BITS]),
        Mirror::constant("SHOWN_COLOR", "view/switches", "SHOWN_COLOR", [SHOWN_COLOR]),
        Mirror::constant("SHOWN_VECTOR", "view/switches", "SHOWN_VECTOR", [SHOWN_VECTOR]),
        Mirror::switch("TRANSFORM", "view/display", "TRANSFORM"),
        Mirror::switch("BLOOM", "view/display", "BLOOM"),
        Mirror::switch("BACKDROP", "view/background", "BACKDROP"),
        Mirror::switch("GROUND", "view/background", "GROUND"),
    ];
    let transforms = [
        ("STANDARD", Transform::STANDARD),
        ("AGX", Transform::AGX),
        ("ACES", Transform::ACES),
        ("ENCODED", Transform::ENCODED),
        ("NEUTRAL", Transform::NEUTRAL),
        ("AGX_PUNCHY", Transform::AGX_PUNCHY),
    ];
    mirrors.extend(transforms.map(|(name, Transform(number))| Mirror::constant(name, "view/display", name, [number])));
    let backdrops = [
        ("ENVIRONMENT", Backdrop::ENVIRONMENT),
        ("BLURRED", Backdrop::BLURRED),
        ("STUDIO", Backdrop::STUDIO),
        ("NOTHING", Backdrop::NOTHING),
    ];
    mirrors.extend(backdrops.map(|(name, Backdrop(number))| Mirror::constant(name, "view/background", name, [number])));
    mirrors.extend(MAP_BITS.map(|(name, bit)| Mirror::constant(name, "view/switches", name, [bit])));
    let switches = Switches::default().named();
    mirrors.extend(switches.map(|(name, _)| Mirror::switch(name, "view/switches", name)));
    mirrors.extend(
        Mode::numbers().map(|(name, number)| Mirror::constant(name, "view/modes", &name.to_uppercase(), [number])),
    );
    let over_faces = ["view/halve_cube", "view/panorama_to_cube", "view/prefilter"];
    mirrors.extend(over_faces.map(|file| Mirror::workgroup("the cube map's GROUP", file, "main", [GROUP, GROUP, 1])));
    mirrors
}
