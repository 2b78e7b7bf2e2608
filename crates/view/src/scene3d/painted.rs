//! Pictures that surfaces have on them, on the device.

use sinew_pictures::render::Image;
use std::sync::Arc;
use wgpu::util::DeviceExt;
use wgpu::*;

/// Pixels a side at most: finer pictures are made coarser.
const MOST: usize = 2048;

/// Layers of a texture, one a picture, all brought to one size.
pub struct Painted {
    pictures: Vec<Arc<Image>>,
    view: TextureView,
    sampler: Sampler,
}

impl Painted {
    /// Of no picture yet.
    pub fn new(device: &Device, queue: &Queue) -> Self {
        let sampler = device.create_sampler(&SamplerDescriptor {
            label: Some("pictures"),
            address_mode_u: AddressMode::Repeat,
            address_mode_v: AddressMode::Repeat,
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            mipmap_filter: MipmapFilterMode::Linear,
            ..SamplerDescriptor::default()
        });
        Self { pictures: Vec::new(), view: layers(device, queue, &[]), sampler }
    }

    /// Goes over to other pictures, if they are others.
    pub fn hold(&mut self, device: &Device, queue: &Queue, pictures: &[Arc<Image>]) {
        let same = |(a, b): (&Arc<Image>, &Arc<Image>)| Arc::ptr_eq(a, b);
        if self.pictures.len() != pictures.len() || !self.pictures.iter().zip(pictures).all(same) {
            self.view = layers(device, queue, pictures);
            self.pictures = pictures.to_vec();
        }
    }

    /// What `scene.wgsl` binds: the layers and how they are looked at.
    pub fn bound(&self) -> [BindingResource<'_>; 2] {
        [BindingResource::TextureView(&self.view), BindingResource::Sampler(&self.sampler)]
    }
}

/// The layers, each with all of its coarser pictures.
fn layers(device: &Device, queue: &Queue, pictures: &[Arc<Image>]) -> TextureView {
    let most = MOST.min(device.limits().max_texture_dimension_2d as usize);
    let side = |of: fn(&Image) -> usize| pictures.iter().map(|picture| of(picture)).max().unwrap_or(1).clamp(1, most);
    let (width, height) = (side(|image| image.width), side(|image| image.height));
    let levels = width.max(height).ilog2() + 1;
    // one layer alone is no array of layers to OpenGL
    let count = pictures.len().max(2);
    let mut bytes = Vec::new();
    for layer in 0..count {
        let mut level = match pictures.get(layer) {
            Some(image) if image.width > 0 && image.height > 0 => resized(image, width, height),
            _ => Image::new(width, height, [255; 3]),
        };
        for _ in 0..levels {
            bytes.extend(level.pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]));
            level = resized(&level, (level.width / 2).max(1), (level.height / 2).max(1));
        }
    }
    let size = Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: count as u32 };
    let descriptor = TextureDescriptor {
        label: Some("pictures"),
        size,
        mip_level_count: levels,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rgba8UnormSrgb,
        usage: TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let texture = device.create_texture_with_data(queue, &descriptor, util::TextureDataOrder::LayerMajor, &bytes);
    let dimension = Some(TextureViewDimension::D2Array);
    texture.create_view(&TextureViewDescriptor { dimension, ..TextureViewDescriptor::default() })
}

/// A picture in another size: each pixel is the mean of those that lie in it, or the nearest one.
fn resized(image: &Image, width: usize, height: usize) -> Image {
    if (image.width, image.height) == (width, height) {
        return image.clone();
    }
    // from where to where a pixel goes there, one at least
    let span = |at: usize, of: usize, there: usize| {
        let first = at * there / of;
        first..((at + 1) * there / of).max(first + 1)
    };
    let mut resized = Image::new(width, height, [0; 3]);
    for y in 0..height {
        for x in 0..width {
            let (mut sum, mut count) = ([0u32; 3], 0);
            for there_y in span(y, height, image.height) {
                for there_x in span(x, width, image.width) {
                    let colour = image.at(there_x, there_y);
                    (0..3).for_each(|part| sum[part] += u32::from(colour[part]));
                    count += 1;
                }
            }
            resized.pixels[y * width + x] = sum.map(|part| (part / count) as u8);
        }
    }
    resized
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_another_size_has_the_means_of_its_pixels() {
        let mut image = Image::new(4, 2, [0; 3]);
        image.pixels[0] = [200, 100, 40];
        assert_eq!(resized(&image, 2, 1).pixels, [[50, 25, 10], [0; 3]]);
        let larger = resized(&image, 8, 2);
        assert_eq!((larger.at(1, 0), larger.at(2, 0)), ([200, 100, 40], [0; 3]));
        assert_eq!(resized(&image, 1, 1).pixels, [[25, 12, 5]]);
    }
}
