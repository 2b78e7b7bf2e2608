//! Pictures brought to the host.

use super::Scene3d;
use super::target::Target;
use sinew_pictures::render::Image;
use wgpu::*;

impl Scene3d {
    /// Waits until all that was drawn is there; for who measures.
    pub fn wait(&self) {
        // a lost device has nothing to wait for
        let _ = self.device.poll(PollType::wait_indefinitely());
    }

    /// The picture that was drawn last; none where the device is lost.
    pub fn picture(&self) -> Option<Image> {
        self.target.read(&self.device, &self.queue)
    }
}

impl Target {
    /// Brings the picture to the host, and waits for that; none where the device is lost.
    fn read(&self, device: &Device, queue: &Queue) -> Option<Image> {
        let ((width, height), picture) = (self.size, self.resolved.texture());
        let row = (4 * width).next_multiple_of(COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&BufferDescriptor {
            label: Some("picture"),
            size: u64::from(row * height),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            picture.as_image_copy(),
            TexelCopyBufferInfo { buffer: &buffer, layout },
            picture.size(),
        );
        queue.submit([encoder.finish()]);
        buffer.map_async(MapMode::Read, .., |_| ());
        device.poll(PollType::wait_indefinitely()).ok()?;
        let bytes = buffer.get_mapped_range(..).ok()?;
        let rows = bytes.chunks_exact(row as usize);
        let pixels = rows.flat_map(|row| row[..4 * width as usize].chunks_exact(4).map(|p| [p[0], p[1], p[2]]));
        Some(Image { width: width as usize, height: height as usize, pixels: pixels.collect() })
    }
}
