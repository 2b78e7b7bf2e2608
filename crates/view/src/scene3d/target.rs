//! The textures that are drawn into.

use super::pipelines::{DEPTH, Pipelines, SAMPLES};
use wgpu::*;

/// Pixels along each side of the maps of shadows.
const MAP: u32 = 1024;

/// A picture of a size, with what it takes to draw it.
pub struct Target {
    /// Width and height (pixels).
    pub size: (u32, u32),
    samples: TextureView,
    depth: TextureView,
    /// The picture as it is drawn into.
    pub resolved: TextureView,
    /// The picture as others show it: bytes as screens take them.
    pub shown: TextureView,
}

/// The maps of shadows.
pub struct Maps {
    /// What the key light sees, and the sky.
    pub views: [TextureView; 2],
    /// Bound for what they fall on.
    pub group: BindGroup,
}

impl Maps {
    /// On a device.
    pub fn new(device: &Device, pipelines: &Pipelines) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let map = || texture(device, (MAP, MAP), 1, DEPTH, usage).create_view(&TextureViewDescriptor::default());
        let views = [map(), map()];
        let sampler = device.create_sampler(&SamplerDescriptor {
            label: Some("shadows"),
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            compare: Some(CompareFunction::LessEqual),
            ..SamplerDescriptor::default()
        });
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("shadows"),
            layout: &pipelines.shadows,
            entries: &[
                BindGroupEntry { binding: 0, resource: BindingResource::TextureView(&views[0]) },
                BindGroupEntry { binding: 1, resource: BindingResource::TextureView(&views[1]) },
                BindGroupEntry { binding: 2, resource: BindingResource::Sampler(&sampler) },
                BindGroupEntry { binding: 3, resource: BindingResource::TextureView(&views[0]) },
                BindGroupEntry { binding: 4, resource: BindingResource::TextureView(&views[1]) },
            ],
        });
        Self { views, group }
    }
}

impl Target {
    /// Of a size (pixels), each side at least 1, and a format.
    pub fn new(device: &Device, (width, height): (u32, u32), colour: TextureFormat) -> Self {
        let most = device.limits().max_texture_dimension_2d;
        let size = (width.clamp(1, most), height.clamp(1, most));
        let whole = TextureViewDescriptor::default();
        let usage = TextureUsages::RENDER_ATTACHMENT;
        let of_picture = usage | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        let picture = texture(device, size, 1, colour, of_picture);
        let bytes = TextureViewDescriptor { format: Some(colour.remove_srgb_suffix()), usage: None, ..whole.clone() };
        Self {
            size,
            samples: texture(device, size, SAMPLES, colour, usage).create_view(&whole),
            depth: texture(device, size, SAMPLES, DEPTH, usage).create_view(&whole),
            resolved: picture.create_view(&whole),
            shown: picture.create_view(&bytes),
        }
    }

    /// Begins to draw the picture.
    pub fn pass<'a>(&self, encoder: &'a mut CommandEncoder) -> RenderPass<'a> {
        encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &self.samples,
                depth_slice: None,
                resolve_target: Some(&self.resolved),
                ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Discard },
            })],
            depth_stencil_attachment: Some(depth(&self.depth, 0.0)),
            ..RenderPassDescriptor::default()
        })
    }
}

/// What is cleared to a depth and kept for the pass only, or for who looks at it.
pub fn depth(view: &TextureView, to: f32) -> RenderPassDepthStencilAttachment<'_> {
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(Operations { load: LoadOp::Clear(to), store: StoreOp::Store }),
        stencil_ops: None,
    }
}

fn texture(
    device: &Device,
    (width, height): (u32, u32),
    samples: u32,
    format: TextureFormat,
    usage: TextureUsages,
) -> Texture {
    let plain = [format.remove_srgb_suffix()];
    device.create_texture(&TextureDescriptor {
        label: Some("scene"),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: if format.is_srgb() && samples == 1 { &plain } else { &[] },
    })
}
