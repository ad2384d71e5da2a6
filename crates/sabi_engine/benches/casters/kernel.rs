//! Kernels that follow rays, each with its own buffers and nothing else.

use std::time::Instant;

use sabi_gpu::choose_adapter;
use sabi_nodes::link::{Given, ModuleSpec};
use sabi_surface::bvh::Bvh;
use wgpu::util::DeviceExt as _;

use super::Ray;
use super::bvh2::Bvh2;
use super::setup::adapter;

/// Rows along a table's side, as `table_texel` in `shaders/lib/atlas.wgsl` has it.
const TABLE_WIDTH: usize = 8192;
const ATLAS: &str = include_str!("../../../../shaders/lib/atlas.wgsl");
const TWO: &str = include_str!("bvh2.wgsl");

/// A device.
pub(crate) struct Machine {
    pub(crate) name: String,
    device: wgpu::Device,
    queue: wgpu::Queue,
}

impl Machine {
    /// Opens the adapter that all benches run on.
    pub(crate) fn open() -> Machine {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        let adapter = choose_adapter(&adapter(), &adapters, None).unwrap();
        let descriptor = wgpu::DeviceDescriptor {
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).unwrap();
        Machine {
            name: adapter.get_info().name,
            device,
            queue,
        }
    }

    fn buffer(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytes,
            usage,
        })
    }

    /// Rows of four numbers as a texture of bit patterns.
    fn table(&self, bytes: &[u8]) -> wgpu::TextureView {
        let line = TABLE_WIDTH * 16;
        let mut padded = bytes.to_vec();
        padded.resize(bytes.len().next_multiple_of(line), 0);
        let descriptor = wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: TABLE_WIDTH as u32,
                height: (padded.len() / line) as u32,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        };
        let order = wgpu::util::TextureDataOrder::LayerMajor;
        let texture = self
            .device
            .create_texture_with_data(&self.queue, &descriptor, order, &padded);
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }
}

/// A kernel over all rays.
pub(crate) struct Kernel {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    /// Index of the bind group in the shader.
    at: u32,
    hits: wgpu::Buffer,
    groups: [u32; 2],
    count: usize,
}

impl Kernel {
    /// The one that Sabi uses.
    pub(crate) fn wide(machine: &Machine, bvh: &Bvh, shot: &[Ray]) -> Kernel {
        let rows = bvh.scaled_triangle_rows();
        let (center, scale) = bvh.scaled_from_model();
        let mut constants: Vec<u8> = center.iter().chain([&scale]).flat_map(|x| x.to_le_bytes()).collect();
        let [row, _] = groups_of(shot.len());
        constants.extend([shot.len() as u32, row, 0, 0].iter().flat_map(|x| x.to_le_bytes()));
        let nodes = machine.table(bytemuck::cast_slice(&bvh.tree().nodes));
        let triangles = machine.table(bytemuck::cast_slice(&rows));
        let spec = ModuleSpec {
            label: "cast",
            files: vec!["surface/cast"],
            given: vec![Given::group("SURFACE_GROUP", 0)],
        };
        let linked = spec.link().unwrap();
        Kernel::new(machine, (linked.wgsl(), 1), &constants, [nodes, triangles], shot)
    }

    /// The tree of two boxes a node.
    pub(crate) fn two(machine: &Machine, bvh: &Bvh2, shot: &[Ray]) -> Kernel {
        let [row, _] = groups_of(shot.len());
        let constants: Vec<u8> = [shot.len() as u32, row, 0, 0]
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let nodes = machine.table(bytemuck::cast_slice(&bvh.nodes));
        let triangles = machine.table(bytemuck::cast_slice(&bvh.triangles));
        let start = ATLAS.find("const TABLE_BITS").unwrap();
        let length = ATLAS[start..].find("\n}\n").unwrap() + 3;
        let text = format!("{TWO}\n{}", &ATLAS[start..start + length]);
        Kernel::new(machine, (&text, 0), &constants, [nodes, triangles], shot)
    }

    fn new(
        machine: &Machine,
        (text, at): (&str, u32),
        constants: &[u8],
        [nodes, triangles]: [wgpu::TextureView; 2],
        shot: &[Ray],
    ) -> Kernel {
        let module = machine.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let pipeline = machine
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: None,
                module: &module,
                entry_point: Some("main"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            });
        let constants = machine.buffer(constants, wgpu::BufferUsages::UNIFORM);
        let rays = machine.buffer(bytemuck::cast_slice(shot), wgpu::BufferUsages::STORAGE);
        let none = vec![0_u8; 8 * shot.len()];
        let hits = machine.buffer(&none, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let resources = [
            constants.as_entire_binding(),
            wgpu::BindingResource::TextureView(&nodes),
            wgpu::BindingResource::TextureView(&triangles),
            rays.as_entire_binding(),
            hits.as_entire_binding(),
        ];
        let entries = resources
            .into_iter()
            .enumerate()
            .map(|(binding, resource)| wgpu::BindGroupEntry {
                binding: binding as u32,
                resource,
            });
        let group = machine.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(at),
            entries: &entries.collect::<Vec<_>>(),
        });
        Kernel {
            pipeline,
            group,
            at,
            hits,
            groups: groups_of(shot.len()),
            count: shot.len(),
        }
    }

    /// Returns the seconds that it takes, and the number of rays that hit.
    pub(crate) fn run(&self, machine: &Machine) -> (f64, usize) {
        let mut encoder = machine
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(self.at, &self.group, &[]);
            pass.dispatch_workgroups(self.groups[0], self.groups[1], 1);
        }
        let started = Instant::now();
        machine.queue.submit([encoder.finish()]);
        machine.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        (started.elapsed().as_secs_f64(), self.hits(machine))
    }

    fn hits(&self, machine: &Machine) -> usize {
        let mapped = machine.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 8 * self.count as u64,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = machine
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&self.hits, 0, &mapped, 0, 8 * self.count as u64);
        machine.queue.submit([encoder.finish()]);
        mapped.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
        machine.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        let view = mapped.get_mapped_range(..);
        let rows: &[[f32; 2]] = bytemuck::cast_slice(&view);
        rows.iter().filter(|[distance, _]| *distance >= 0.0).count()
    }
}

/// Workgroups of 64 rays, in rows that adapters allow.
fn groups_of(rays: usize) -> [u32; 2] {
    let groups = (rays as u32).div_ceil(64);
    [groups.min(32_768), groups.div_ceil(32_768)]
}
