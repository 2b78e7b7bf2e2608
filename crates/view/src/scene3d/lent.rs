//! Bodies that are drawn from where their nodes are on the device: corners are made once, and a kernel moves them.

use super::triangles::{self, Corner, Surface};
use sinew::GpuColumn;
use sinew_pictures::render::Camera;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::*;

/// Where a surface's nodes are on the device.
#[derive(Clone, Copy)]
pub struct Lent<'a> {
    /// Their displacements.
    pub column: &'a GpuColumn,
    /// So many times those they are drawn from where they rest.
    pub deformation: f32,
}

/// The kernel.
pub struct Deform {
    pipeline: ComputePipeline,
}

/// Surfaces whose corners are on the device.
pub struct Kept {
    /// What they are of.
    pub key: u64,
    /// The surfaces.
    pub bodies: Vec<KeptBody>,
}

/// One of them.
pub struct KeptBody {
    /// Its corners.
    pub corners: Buffer,
    /// How many there are.
    pub count: u32,
    /// Its place among the surfaces that are drawn so.
    place: usize,
    how: Buffer,
    group: BindGroup,
    rows: u32,
    first: u32,
}

/// Workgroups along an axis, at most.
const MOST_GROUPS: u32 = 65_535;

impl Deform {
    /// On a device.
    pub fn new(device: &Device) -> Self {
        let module = device.create_shader_module(include_wgsl!("deform.wgsl"));
        let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some("deform"),
            layout: None,
            module: &module,
            entry_point: Some("deform"),
            compilation_options: PipelineCompilationOptions::default(),
            cache: None,
        });
        Self { pipeline }
    }

    /// Makes the corners of a surface, by its place among those that are drawn so; nothing of one that has no faces.
    pub fn keep(&self, device: &Device, place: usize, surface: &Surface<'_>, camera: &Camera) -> Option<KeptBody> {
        let (corners, sources) = triangles::kept(surface, camera);
        let column = surface.lent?.column;
        if corners.is_empty() || column.numbers != 3 {
            return None;
        }
        let rows = column.node_rows.iter().max().map_or(0, |row| row + 1);
        let mut rest = vec![[0.0f32; 3]; rows as usize];
        for (row, place) in column.node_rows.iter().zip(surface.rest) {
            rest[*row as usize] = place.to_array();
        }
        let row_of = |point: u32| column.node_rows.get(point as usize).copied().unwrap_or(0);
        let faces: Vec<[u32; 4]> = surface.layer.faces.iter().map(|face| face.map(row_of)).collect();
        let around = around(rows as usize, &faces);
        let make = |label, contents: &[u8], usage| {
            device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let read = |label, contents: &[u8]| make(label, contents, BufferUsages::STORAGE);
        let usage = BufferUsages::STORAGE | BufferUsages::VERTEX;
        let corners_on_device = make("kept corners", bytemuck::cast_slice(&corners), usage);
        let how = device.create_buffer(&BufferDescriptor {
            label: Some("how"),
            size: 16,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let buffers = [
            how.clone(),
            column.buffer.clone(),
            read("rest", bytemuck::cast_slice(&rest)),
            read("faces", bytemuck::cast_slice(&faces)),
            read("around", bytemuck::cast_slice(&around)),
            read("sources", bytemuck::cast_slice(&sources)),
            corners_on_device.clone(),
        ];
        let entries: Vec<BindGroupEntry<'_>> = (0..)
            .zip(&buffers)
            .map(|(binding, buffer)| BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("deform"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let (count, first) = (corners.len() as u32, (column.bytes.start / 4) as u32);
        Some(KeptBody { corners: corners_on_device, count, place, how, group, rows, first })
    }

    /// Moves the corners to where nodes will be by then; surfaces are so many times as far moved.
    pub fn run(&self, queue: &Queue, encoder: &mut CommandEncoder, bodies: &[KeptBody], deformations: &[f32]) {
        if bodies.is_empty() {
            return;
        }
        for body in bodies {
            let deformation = deformations.get(body.place).copied().unwrap_or(1.0);
            let how = [body.first, body.count, deformation.to_bits(), body.rows];
            queue.write_buffer(&body.how, 0, bytemuck::cast_slice(&how));
        }
        let mut pass =
            encoder.begin_compute_pass(&ComputePassDescriptor { label: Some("deform"), ..Default::default() });
        pass.set_pipeline(&self.pipeline);
        for body in bodies {
            let groups = body.count.div_ceil(64);
            pass.set_bind_group(0, &body.group, &[]);
            pass.dispatch_workgroups(groups.min(MOST_GROUPS), groups.div_ceil(MOST_GROUPS), 1);
        }
    }
}

/// Of each row where its list of faces begins, and where the last one ends; then the lists.
fn around(rows: usize, faces: &[[u32; 4]]) -> Vec<u32> {
    let points =
        |face: &[u32; 4]| face.iter().copied().take(if face[2] == face[3] { 3 } else { 4 }).collect::<Vec<_>>();
    let mut lists: Vec<Vec<u32>> = vec![Vec::new(); rows];
    for (number, face) in (0..).zip(faces) {
        points(face).into_iter().for_each(|row| lists[row as usize].push(number));
    }
    let mut starts = vec![0];
    for list in &lists {
        starts.push(starts.last().copied().unwrap_or(0) + list.len() as u32);
    }
    starts.extend(lists.into_iter().flatten());
    starts
}

/// Corners are what `deform.wgsl` takes them for.
const _: () = assert!(size_of::<Corner>() == 44);

#[cfg(test)]
mod tests {
    use super::around;

    #[test]
    fn each_point_knows_the_faces_around_it() {
        assert_eq!(around(5, &[[0, 1, 2, 2], [1, 2, 4, 3]]), [0, 1, 3, 5, 6, 7, 0, 0, 1, 0, 1, 1, 1]);
    }
}
