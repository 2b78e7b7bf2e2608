//! What `scene.wgsl` is compiled to.

use super::triangles::Corner;
use wgpu::*;

/// Samples a pixel.
pub const SAMPLES: u32 = 4;
/// How far things are.
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// All pipelines, and how what they bind is laid out.
pub struct Pipelines {
    /// What is drawn into: light, stored as screens take it. Where a texture cannot be looked at in another format than
    /// its own (WebGL) it is one of bytes, and the shader encodes light.
    pub colour: TextureFormat,
    /// Of the scene.
    pub scene: BindGroupLayout,
    /// Of the maps of shadows.
    pub shadows: BindGroupLayout,
    /// What the key light sees, and the sky.
    pub maps: [RenderPipeline; 2],
    /// The background, what is solid, the shadow on the ground, what is seen through.
    pub behind: RenderPipeline,
    /// See above.
    pub solid: RenderPipeline,
    /// See above.
    pub ground: RenderPipeline,
    /// See above.
    pub clear: RenderPipeline,
}

const ATTRIBUTES: [VertexAttribute; 5] =
    vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32, 4 => Uint32];

/// A pipeline as it differs from the others.
struct Kind<'a> {
    name: &'a str,
    layout: &'a PipelineLayout,
    entries: (&'a str, &'a str),
    corners: bool,
    /// Whether it is of a map of shadows.
    map: bool,
    /// Whether what is behind shines through.
    blend: bool,
    /// Whether depth is looked at.
    depth: bool,
}

impl Pipelines {
    /// On a device.
    pub fn new(device: &Device) -> Self {
        let colour = match device.adapter_info().backend {
            Backend::Gl => TextureFormat::Rgba8Unorm,
            _ => TextureFormat::Rgba8UnormSrgb,
        };
        let module = device.create_shader_module(include_wgsl!("scene.wgsl"));
        let scene = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("scene"),
            entries: &[
                entry(0, ShaderStages::VERTEX_FRAGMENT, buffer(BufferBindingType::Uniform)),
                entry(1, ShaderStages::FRAGMENT, texture(TextureSampleType::Float { filterable: false })),
                entry(2, ShaderStages::FRAGMENT, buffer(BufferBindingType::Uniform)),
                entry(3, ShaderStages::FRAGMENT, layers()),
                entry(4, ShaderStages::FRAGMENT, BindingType::Sampler(SamplerBindingType::Filtering)),
            ],
        });
        let shadows = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("shadows"),
            entries: &[
                entry(0, ShaderStages::FRAGMENT, texture(TextureSampleType::Depth)),
                entry(1, ShaderStages::FRAGMENT, texture(TextureSampleType::Depth)),
                entry(2, ShaderStages::FRAGMENT, BindingType::Sampler(SamplerBindingType::Comparison)),
                // the same maps as numbers: GLSL has no texture that is both compared and read
                entry(3, ShaderStages::FRAGMENT, texture(TextureSampleType::Float { filterable: false })),
                entry(4, ShaderStages::FRAGMENT, texture(TextureSampleType::Float { filterable: false })),
            ],
        });
        let layout = |groups: &[Option<&BindGroupLayout>]| {
            device.create_pipeline_layout(&PipelineLayoutDescriptor {
                label: Some("scene"),
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        let (one, two) = (layout(&[Some(&scene)]), layout(&[Some(&scene), Some(&shadows)]));
        let make = |kind: Kind<'_>| make(device, &module, &kind, colour);
        let usual =
            |name, entries| Kind { name, layout: &two, entries, corners: true, map: false, blend: false, depth: true };
        let map = |entry| make(Kind { layout: &one, map: true, ..usual("shadows", (entry, "shadow")) });
        Self {
            colour,
            maps: [map("shadow_of_key"), map("shadow_of_sky")],
            behind: make(Kind { corners: false, depth: false, ..usual("behind", ("whole", "behind")) }),
            solid: make(usual("solid", ("corner", "solid"))),
            ground: make(Kind { corners: false, blend: true, ..usual("ground", ("below", "ground")) }),
            clear: make(Kind { blend: true, ..usual("clear", ("corner", "clear")) }),
            scene,
            shadows,
        }
    }
}

fn entry(binding: u32, visibility: ShaderStages, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

fn buffer(ty: BufferBindingType) -> BindingType {
    BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None }
}

/// Of pictures.
fn layers() -> BindingType {
    let sample_type = TextureSampleType::Float { filterable: true };
    BindingType::Texture { sample_type, view_dimension: TextureViewDimension::D2Array, multisampled: false }
}

fn texture(sample_type: TextureSampleType) -> BindingType {
    BindingType::Texture { sample_type, view_dimension: TextureViewDimension::D2, multisampled: false }
}

fn make(device: &Device, module: &ShaderModule, kind: &Kind<'_>, colour: TextureFormat) -> RenderPipeline {
    let corners = VertexBufferLayout {
        array_stride: size_of::<Corner>() as u64,
        step_mode: VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    };
    let buffers = [Some(corners)];
    let blend = kind.blend.then_some(BlendState::ALPHA_BLENDING);
    let target = [Some(ColorTargetState { format: colour, blend, write_mask: ColorWrites::ALL })];
    // depth is 1 before the eye and 0 infinitely far, but in maps of shadows
    let nearer = if kind.map { CompareFunction::Less } else { CompareFunction::Greater };
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some(kind.name),
        layout: Some(kind.layout),
        vertex: VertexState {
            module,
            entry_point: Some(kind.entries.0),
            compilation_options: PipelineCompilationOptions::default(),
            buffers: if kind.corners { &buffers } else { &[] },
        },
        primitive: PrimitiveState {
            topology: if kind.corners { PrimitiveTopology::TriangleList } else { PrimitiveTopology::TriangleStrip },
            ..PrimitiveState::default()
        },
        depth_stencil: Some(DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(kind.depth && !kind.blend),
            depth_compare: Some(if kind.depth { nearer } else { CompareFunction::Always }),
            stencil: StencilState::default(),
            bias: DepthBiasState::default(),
        }),
        multisample: MultisampleState { count: if kind.map { 1 } else { SAMPLES }, ..MultisampleState::default() },
        fragment: Some(FragmentState {
            module,
            entry_point: Some(kind.entries.1),
            compilation_options: PipelineCompilationOptions::default(),
            targets: if kind.map { &[] } else { &target },
        }),
        multiview_mask: None,
        cache: None,
    })
}
