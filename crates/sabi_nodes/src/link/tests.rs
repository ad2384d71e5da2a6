//! Tests that linked kernels are text that naga accepts.

use sabi_graph::PortType;

use super::{
    Binding, Call, Convert, Domain, Format, Kernel, KernelSpec, KernelStore, LinkError, Operand, StoredLayout, link,
};
use crate::Library;
use crate::kind::{Channel, InputDefault};

fn link_with(spec: &KernelSpec, library: &Library) -> Result<Kernel, LinkError> {
    link(spec, |id| library.kind(id), library.libraries())
}

fn linked(spec: &KernelSpec) -> Kernel {
    let kernel = link_with(spec, &Library::builtin()).unwrap_or_else(|error| panic!("{error}"));
    let check = kernel.module.check();
    check.unwrap_or_else(|fault| panic!("{fault}\n{}", kernel.module.wgsl()));
    kernel
}

fn call(kind: &str, function: &str, inputs: Vec<Binding>, block: usize) -> Call {
    Call {
        kind: kind.to_owned(),
        function: function.to_owned(),
        inputs,
        passes: Vec::new(),
        survey: None,
        normals: None,
        param_masks: Vec::new(),
        block,
        by_piece: false,
    }
}

fn mask() -> StoredLayout {
    StoredLayout {
        ty: PortType::Mask,
        channels: Vec::new(),
    }
}

fn stores_mask(of: usize) -> Vec<KernelStore> {
    vec![KernelStore {
        value: Operand::Call(of, Convert::None),
        stored: mask(),
        formats: vec![Format::R32Float],
    }]
}

#[test]
fn two_calls_of_one_kind_share_its_source() {
    let noise = |block| call("noise/simplex", "mask", vec![Binding::Default], block);
    let inputs = vec![
        Binding::Value(Operand::Call(0, Convert::None)),
        Binding::Value(Operand::Call(1, Convert::None)),
        Binding::Default,
    ];
    let spec = KernelSpec {
        calls: vec![noise(0), noise(1), call("blend/mask", "mask", inputs, 2)],
        loads: Vec::new(),
        stores: stores_mask(2),
        domain: Domain::AllTexels,
        on_points: false,
    };
    let kernel = linked(&spec);
    assert_eq!(kernel.module.wgsl().matches("fn n1_noise_simplex__mask(").count(), 1);
    assert_eq!(kernel.module.wgsl().matches("= n1_noise_simplex__mask(").count(), 2);
    assert_eq!(kernel.layout.calls.len(), 3);
}

#[test]
fn a_parameter_that_bounds_a_loop_is_clamped_on_the_device() {
    let spec = KernelSpec {
        calls: vec![call("noise/simplex", "mask", vec![Binding::Default], 0)],
        loads: Vec::new(),
        stores: stores_mask(0),
        domain: Domain::AllTexels,
        on_points: false,
    };
    let kernel = linked(&spec);
    assert!(
        kernel
            .module
            .wgsl()
            .contains("bounded.octaves = clamp(bounded.octaves, 1u, 16u);"),
        "{}",
        kernel.module.wgsl()
    );
}

#[test]
fn a_field_reads_a_texture_and_does_not_write_ghosts() {
    let spec = KernelSpec {
        calls: vec![call("filter/smooth", "mask", vec![Binding::Field(0)], 0)],
        loads: vec![mask()],
        stores: stores_mask(0),
        domain: Domain::OwnedTexels,
        on_points: false,
    };
    let kernel = linked(&spec);
    assert_eq!((kernel.reads, kernel.writes.len()), (1, 1));
    assert!(
        kernel
            .module
            .wgsl()
            .contains("if (owner & GHOST_BIT) != 0u { return; }")
    );
}

#[test]
fn every_result_of_every_kind_links_alone_with_all_inputs_switched() {
    let library = Library::builtin();
    let points = || library.kinds().filter(|kind| kind.shape == crate::kind::Shape::Point);
    let mut seen = 0;
    for kind in points() {
        for output in &kind.outputs {
            let all = |ty| StoredLayout {
                ty,
                channels: if ty == PortType::Material {
                    Channel::ALL.to_vec()
                } else {
                    Vec::new()
                },
            };
            let stored = all(output.ty);
            let formats = stored.planes().iter().map(|plane| plane.format()).collect();
            let spec = KernelSpec {
                calls: vec![call(
                    &kind.id,
                    &output.name,
                    (0..kind.inputs.len()).map(Binding::Switch).collect(),
                    0,
                )],
                loads: kind.inputs.iter().map(|input| all(input.ty)).collect(),
                stores: vec![KernelStore {
                    value: Operand::Call(0, Convert::None),
                    stored,
                    formats,
                }],
                domain: Domain::AllTexels,
                on_points: false,
            };
            let kernel = linked(&spec);
            assert_eq!(kernel.layout.flags.is_some(), !kind.inputs.is_empty(), "{}", kind.id);
            seen += 1;
        }
    }
    assert!(seen >= points().count() && seen > 20);
}

#[test]
fn a_kind_that_shoots_rays_links_with_all_results_and_an_entry_point_for_rays() {
    let library = Library::builtin();
    let kinds: Vec<_> = library.kinds().filter(|kind| kind.rays.is_some()).collect();
    assert!(kinds.len() >= 6);
    for kind in kinds {
        let store = |(at, output): (usize, &crate::kind::Output)| {
            let stored = StoredLayout {
                ty: output.ty,
                channels: Vec::new(),
            };
            KernelStore {
                value: Operand::Call(at, Convert::None),
                formats: stored.planes().iter().map(|plane| plane.format()).collect(),
                stored,
            }
        };
        let inputs = || kind.inputs.iter().map(|_| Binding::Default).collect();
        let spec = KernelSpec {
            calls: kind
                .outputs
                .iter()
                .map(|output| call(&kind.id, &output.name, inputs(), 0))
                .collect(),
            loads: Vec::new(),
            stores: kind.outputs.iter().enumerate().map(store).collect(),
            domain: Domain::OwnedTexelsByRays,
            on_points: false,
        };
        let kernel = linked(&spec);
        assert!(
            kernel.rays && kernel.module.wgsl().contains("fn shoot(") && kernel.module.wgsl().contains("fn main("),
            "{}",
            kind.id
        );
    }
}

#[test]
fn the_parameter_block_has_the_layout_that_naga_computes() {
    let library = Library::builtin();
    for kind in library.kinds().filter(|kind| kind.rays.is_none()) {
        let Some(output) = kind.outputs.first() else { continue };
        let inputs = kind.inputs.iter().enumerate().map(|(index, input)| match input.reads {
            crate::kind::Reads::Field => Binding::Field(index),
            crate::kind::Reads::Value if input.default == InputDefault::Required => {
                Binding::Value(Operand::Load(index, Convert::None))
            }
            crate::kind::Reads::Value => Binding::Default,
        });
        let stored = |ty| StoredLayout {
            ty,
            channels: Vec::new(),
        };
        let of_passes = kind.passes.iter().map(|pass| stored(pass.function.ty));
        let first = call("noise/white", "mask", vec![Binding::Default], 0);
        let second = Call {
            passes: (0..kind.passes.len())
                .map(|pass| Some(kind.inputs.len() + pass))
                .collect(),
            ..call(&kind.id, &output.name, inputs.collect(), 1)
        };
        let spec = KernelSpec {
            calls: vec![first, second],
            loads: kind.inputs.iter().map(|_| mask()).chain(of_passes).collect(),
            stores: Vec::new(),
            domain: Domain::AllTexels,
            on_points: false,
        };
        let kernel = linked(&spec);
        let module = naga::front::wgsl::parse_str(kernel.module.wgsl()).unwrap();
        let (_, block) = module
            .types
            .iter()
            .find(|(_, ty)| ty.name.as_deref() == Some("Block"))
            .unwrap();
        let naga::TypeInner::Struct { members, span } = &block.inner else {
            panic!("Block is a struct")
        };
        let offset = |name: &str| {
            members
                .iter()
                .find(|m| m.name.as_deref() == Some(name))
                .map(|m| m.offset)
        };
        let ours = &kernel.layout.calls[1];
        assert_eq!(offset("params_1"), ours.params, "{}", kind.id);
        assert_eq!(
            offset("knobs_1"),
            ours.knobs.iter().flatten().next().copied(),
            "{}",
            kind.id
        );
        assert_eq!(*span, kernel.layout.size, "{}", kind.id);
    }
}

#[test]
fn names_in_node_files_never_clash_with_other_files_or_generated_code() {
    let text = |label: &str| {
        format!(
            "//! {label}\n//! Returns its size.\n\nstruct Knobs {{ x: f32 }}\nstruct Params {{\n    /// How much.\n    /// \
             @default 1\n    size: f32,\n}}\nfn bounded(x: f32) -> f32 {{ return Knobs(x).x; }}\nfn gen_bounded_0() -> f32 \
             {{ return 1.0; }}\n/// The size.\nfn mask(params: Params) -> f32 {{ return bounded(params.size) * \
             gen_bounded_0(); }}\n"
        )
    };
    let file = |id: &str| crate::SourceFile {
        path: format!("{id}.wgsl").into(),
        id: id.to_owned(),
        text: text(id),
    };
    let libraries = Library::builtin().libraries().clone();
    let (library, faults) = Library::load(vec![file("a/b_c"), file("a_b/c")], libraries);
    assert!(faults.is_empty(), "{faults:?}");
    let spec = KernelSpec {
        calls: vec![
            call("a/b_c", "mask", Vec::new(), 0),
            call("a_b/c", "mask", Vec::new(), 1),
        ],
        loads: Vec::new(),
        stores: stores_mask(1),
        domain: Domain::AllTexels,
        on_points: false,
    };
    let kernel = link_with(&spec, &library).unwrap_or_else(|error| panic!("{error}"));
    kernel.module.check().unwrap_or_else(|fault| panic!("{fault}"));
}

#[test]
fn a_loaded_result_can_be_stored_as_another_type() {
    let color = StoredLayout {
        ty: PortType::Color,
        channels: Vec::new(),
    };
    let spec = KernelSpec {
        calls: Vec::new(),
        loads: vec![color],
        stores: vec![KernelStore {
            value: Operand::Load(0, Convert::Luminance),
            stored: mask(),
            formats: vec![Format::R32Float],
        }],
        domain: Domain::AllTexels,
        on_points: false,
    };
    assert!(linked(&spec).module.wgsl().contains("let s0 = luminance("));
}

/// Returns the message of the error for a kernel with one call.
fn refused(call: Call, loads: Vec<StoredLayout>) -> String {
    let spec = KernelSpec {
        calls: vec![call],
        loads,
        stores: Vec::new(),
        domain: Domain::AllTexels,
        on_points: false,
    };
    link_with(&spec, &Library::builtin()).unwrap_err().to_string()
}

#[test]
fn a_missing_part_of_a_plan_is_an_error_that_names_the_node() {
    let cases = [
        (
            call("adjust/coverage", "threshold", Vec::new(), 0),
            "the survey for `threshold` of the node kind 'adjust/coverage'",
        ),
        (
            call("filter/blur", "mask", vec![Binding::Field(0)], 0),
            "the result of the pass",
        ),
        (
            call("filter/smooth", "mask", vec![Binding::Default], 0),
            "a source for the input 'source' for `mask` of the node kind 'filter/smooth'",
        ),
        (
            call("filter/smooth", "mask", Vec::new(), 0),
            "a source for the input 'source'",
        ),
        (
            call(
                "adjust/invert",
                "mask",
                vec![Binding::Value(Operand::Load(3, Convert::None))],
                0,
            ),
            "the stored result 3",
        ),
    ];
    for (call, expected) in cases {
        let message = refused(call, vec![mask()]);
        assert!(message.contains(expected), "{message}\ndoes not name\n{expected}");
    }
}

#[test]
fn a_kernel_of_rays_without_a_call_is_an_error() {
    let spec = KernelSpec {
        calls: Vec::new(),
        loads: Vec::new(),
        stores: Vec::new(),
        domain: Domain::OwnedTexelsByRays,
        on_points: false,
    };
    assert!(matches!(
        link_with(&spec, &Library::builtin()),
        Err(LinkError::Incomplete { .. })
    ));
}

#[test]
fn a_shared_function_is_called_once_per_node_for_all_outputs() {
    let stamp = |function, block| call("scatter/stamp", function, vec![Binding::Default; 3], block);
    let spec = KernelSpec {
        calls: vec![stamp("mask", 0), stamp("height", 0), stamp("id", 0), stamp("mask", 1)],
        loads: Vec::new(),
        stores: (0..4).flat_map(stores_mask).collect(),
        domain: Domain::AllTexels,
        on_points: false,
    };
    let kernel = linked(&spec);
    let text = kernel.module.wgsl();
    assert_eq!(text.matches("= n0_scatter_stamp__found(").count(), 2, "{text}");
    assert_eq!(text.matches("= n0_scatter_stamp__mask(at, shared_0_0,").count(), 1);
    assert_eq!(text.matches("= n0_scatter_stamp__mask(at, shared_1_0,").count(), 1);
}

#[test]
fn switched_inputs_of_a_shared_function_are_declared_once_per_node() {
    let vector = || StoredLayout {
        ty: PortType::Vector,
        channels: Vec::new(),
    };
    let inputs = || vec![Binding::Switch(0), Binding::Switch(1), Binding::Switch(2)];
    let spec = KernelSpec {
        calls: vec![
            call("scatter/stamp", "mask", inputs(), 0),
            call("scatter/stamp", "height", inputs(), 0),
        ],
        loads: vec![vector(), vector(), mask()],
        stores: (0..2).flat_map(stores_mask).collect(),
        domain: Domain::AllTexels,
        on_points: false,
    };
    let kernel = linked(&spec);
    assert_eq!(kernel.module.wgsl().matches("var in_0_2 = ").count(), 1);
}
