//! Faces as the kernels of loads on the surface see them.

use crate::components::{Alive, Authoring, FaceCorners};
use bevy_ecs::prelude::*;

/// Faces that one kernel loads.
pub(crate) struct FaceLoad {
    /// The faces.
    pub faces: FaceCorners,
    /// The block behind them, when its elements can go.
    pub alive: Option<Entity>,
}

/// A load's faces in one, or, where elements can go, block by block: a kernel looks at one block's `alive` only.
pub(crate) fn face_loads(faces: &FaceCorners, body: Entity, world: &World) -> Vec<FaceLoad> {
    let blocks = world.get::<Authoring>(body).map_or(&[][..], |authoring| &authoring.blocks);
    if !blocks.iter().any(|&block| world.get::<Alive>(block).is_some()) {
        return vec![FaceLoad { faces: faces.clone(), alive: None }];
    }
    let of_block = |(place, &block): (usize, &Entity)| {
        let alive = world.get::<Alive>(block).map(|_| block);
        FaceLoad { faces: faces_behind(faces, place as u32), alive }
    };
    blocks.iter().enumerate().map(of_block).filter(|load| !load.faces.rows.is_empty()).collect()
}

/// Only the faces of a block's elements; the lists of all faces stay as they are.
fn faces_behind(faces: &FaceCorners, block: u32) -> FaceCorners {
    let (rows, factors) = (Vec::new(), Vec::new());
    let mut some = FaceCorners { rows, factors, starts: vec![0], corners: Vec::new(), ..faces.clone() };
    for (i, &row) in faces.rows.iter().enumerate() {
        let corners = &faces.corners[faces.starts[i] as usize..faces.starts[i + 1] as usize];
        some.corners.extend(corners.iter().filter(|&&corner| faces.elements[corner as usize / 4].0 == block));
        if some.corners.len() as u32 > some.starts[some.rows.len()] {
            some.rows.push(row);
            some.factors.extend(faces.factors.get(i));
            some.starts.push(some.corners.len() as u32);
        }
    }
    some
}
