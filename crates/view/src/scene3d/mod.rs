//! Bodies, tools and their shadows drawn by a graphics device into a texture that this owns: 4 samples a pixel, depth,
//! no window.
//!
//! What is drawn are the layers of `sinew_pictures`, seen by its cameras and with its colours and its light, so that a
//! picture of the viewer and one of `sinew render` are of the same scene.

mod lent;
mod painted;
mod pipelines;
// what waits for the device, as nothing may in a page
#[cfg(not(target_arch = "wasm32"))]
mod read;
mod target;
mod triangles;
mod uniform;

pub use lent::Lent;
pub use triangles::Surface;
pub use uniform::{Look, Tissue};

use lent::{Deform, Kept, KeptBody};
use painted::Painted;
use pipelines::Pipelines;
use sinew_pictures::render::{Camera, Extent, Plane, Scale};
use target::{Maps, Target, depth};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::*;

/// What is drawn.
pub struct Scene<'a> {
    /// Surfaces; those that are seen through in the order in which they are.
    pub surfaces: &'a [Surface<'a>],
    /// Another one whenever surfaces that are drawn from where they are on the device have other faces.
    pub key: u64,
    /// Colours of values.
    pub scale: Scale,
    /// Takes away what lies beyond, of surfaces that it cuts.
    pub plane: Option<Plane>,
    /// What bodies fill, for shadows.
    pub bodies: Extent,
    /// Up, of length 1, and where the ground is along that (m).
    pub ground: (glam::Vec3, f32),
    /// How it looks.
    pub look: Look,
}

/// Draws scenes on a device.
pub struct Scene3d {
    device: Device,
    queue: Queue,
    pipelines: Pipelines,
    /// Made when something is drawn from where it is on the device: not every device has kernels.
    deform: Option<Deform>,
    kept: Option<Kept>,
    maps: Maps,
    painted: Painted,
    target: Target,
}

impl Scene3d {
    /// On a device, into a picture of a size (pixels).
    pub fn new(device: Device, queue: Queue, size: (u32, u32)) -> Self {
        let pipelines = Pipelines::new(&device);
        let maps = Maps::new(&device, &pipelines);
        let target = Target::new(&device, size, pipelines.colour);
        let painted = Painted::new(&device, &queue);
        Self { device, queue, pipelines, deform: None, kept: None, maps, painted, target }
    }

    /// Width and height of the picture (pixels).
    pub fn size(&self) -> (u32, u32) {
        self.target.size
    }

    /// Goes over to a picture of another size (pixels): whether it is another texture now.
    pub fn resize(&mut self, size: (u32, u32)) -> bool {
        let changed = size != self.target.size;
        if changed {
            self.target = Target::new(&self.device, size, self.pipelines.colour);
        }
        changed
    }

    /// The picture, in the format `Rgba8Unorm`: bytes as screens take them.
    pub fn texture(&self) -> &TextureView {
        &self.target.shown
    }

    /// Draws a scene.
    pub fn draw(&mut self, scene: &Scene<'_>, camera: &Camera) {
        self.keep(scene, camera);
        let kept: &[KeptBody] = self.kept.as_ref().map_or(&[], |kept| &kept.bodies);
        let triangles = triangles::of(scene.surfaces, camera);
        self.painted.hold(&self.device, &self.queue, &triangles.pictures);
        let group = self.bind(scene, camera);
        let corners = self.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("corners"),
            contents: bytemuck::cast_slice(&triangles.corners),
            usage: BufferUsages::VERTEX,
        });
        let mut encoder = self.device.create_command_encoder(&CommandEncoderDescriptor::default());
        let deformations = scene.surfaces.iter().filter_map(|surface| Some(surface.lent?.deformation));
        if let Some(deform) = &self.deform {
            deform.run(&self.queue, &mut encoder, kept, &deformations.collect::<Vec<_>>());
        }
        for (pipeline, view) in self.pipelines.maps.iter().zip(&self.maps.views) {
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("shadows"),
                depth_stencil_attachment: Some(depth(view, 1.0)),
                ..RenderPassDescriptor::default()
            });
            pass.set_bind_group(0, &group, &[]);
            draw(&mut pass, pipeline, &corners, 0..triangles.casting);
            kept.iter().for_each(|body| draw(&mut pass, pipeline, &body.corners, 0..body.count as usize));
        }
        {
            let mut pass = self.target.pass(&mut encoder);
            pass.set_bind_group(0, &group, &[]);
            pass.set_bind_group(1, &self.maps.group, &[]);
            pass.set_pipeline(&self.pipelines.behind);
            pass.draw(0..3, 0..1);
            let solid = &self.pipelines.solid;
            draw(&mut pass, solid, &corners, 0..triangles.solid);
            kept.iter().for_each(|body| draw(&mut pass, solid, &body.corners, 0..body.count as usize));
            if scene.look.ground {
                pass.set_pipeline(&self.pipelines.ground);
                pass.draw(0..4, 0..1);
            }
            draw(&mut pass, &self.pipelines.clear, &corners, triangles.solid..triangles.corners.len());
        }
        self.queue.submit([encoder.finish()]);
    }

    /// Makes the corners of what is drawn from where it is on the device, where they are others now.
    fn keep(&mut self, scene: &Scene<'_>, camera: &Camera) {
        let lent = || scene.surfaces.iter().filter(|surface| surface.lent.is_some());
        if lent().next().is_none() {
            self.kept = None;
        } else if self.kept.as_ref().is_none_or(|kept| kept.key != scene.key) {
            let deform = self.deform.get_or_insert_with(|| Deform::new(&self.device));
            let keep = |(place, surface): (usize, &Surface<'_>)| deform.keep(&self.device, place, surface, camera);
            let bodies = lent().enumerate().filter_map(keep);
            self.kept = Some(Kept { key: scene.key, bodies: bodies.collect() });
        }
    }

    fn bind(&self, scene: &Scene<'_>, camera: &Camera) -> BindGroup {
        let buffer = |label, contents: &[f32], usage| {
            let contents = bytemuck::cast_slice(contents);
            self.device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let size = glam::Vec2::new(self.target.size.0 as f32, self.target.size.1 as f32);
        let is_encoded = !self.pipelines.colour.is_srgb();
        let view = buffer("view", &uniform::of(scene, camera, size, is_encoded), BufferUsages::UNIFORM);
        let tissues = buffer("tissues", &uniform::tissues(&scene.look.tissues), BufferUsages::UNIFORM);
        let ramp = uniform::ramp(&scene.scale);
        let ramp = self.device.create_texture_with_data(
            &self.queue,
            &TextureDescriptor {
                label: Some("ramp"),
                size: Extent3d { width: ramp.len() as u32, height: 1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format: TextureFormat::Rgba8UnormSrgb,
                usage: TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            util::TextureDataOrder::LayerMajor,
            ramp.as_flattened(),
        );
        let ramp = ramp.create_view(&TextureViewDescriptor::default());
        let [pictures, sampler] = self.painted.bound();
        self.device.create_bind_group(&BindGroupDescriptor {
            label: Some("scene"),
            layout: &self.pipelines.scene,
            entries: &[
                BindGroupEntry { binding: 0, resource: view.as_entire_binding() },
                BindGroupEntry { binding: 1, resource: BindingResource::TextureView(&ramp) },
                BindGroupEntry { binding: 2, resource: tissues.as_entire_binding() },
                BindGroupEntry { binding: 3, resource: pictures },
                BindGroupEntry { binding: 4, resource: sampler },
            ],
        })
    }
}

fn draw(pass: &mut RenderPass<'_>, pipeline: &RenderPipeline, corners: &Buffer, which: std::ops::Range<usize>) {
    if !which.is_empty() {
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, corners.slice(..));
        pass.draw(which.start as u32..which.end as u32, 0..1);
    }
}
