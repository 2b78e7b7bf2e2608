//! How far the elements of a block are deformed: the kernel of strains on its columns.

use super::{Columns, Deformed, ROWS_A_PART, StiffnessTracker};
use crate::backend::cpu::{Cpu, Kept, Strain, StrainColumns, Visit, strains};
use crate::components::*;
use crate::elements::with_element_of;
use crate::math::{LANES, lane_place};
use bevy_ecs::prelude::*;
use std::ops::Range;

impl StiffnessTracker {
    /// What strains are taken from; `None` where the world has the block no longer.
    pub(super) fn columns<'w>(&self, world: &'w World) -> Option<Columns<'w>> {
        let block = world.get::<Block>(self.entity)?;
        Some(Columns {
            cpu: world.resource::<Cpu>(),
            block,
            u: world.get::<Displacement>(block.body)?,
            d: world.get::<DisplacementIncrement>(block.body)?,
            connectivity: world.get::<Connectivity>(self.entity)?,
            shape: world.get::<RestShape>(self.entity)?,
            fibres: world.get::<FibreDirection>(self.entity),
        })
    }

    /// Visits the elements of some groups that are there, and keeps how far those of a part are deformed; what they
    /// come to, and how many they are.
    pub(super) fn strains(
        &self,
        of: &Columns<'_>,
        groups: Range<usize>,
        visit: Option<Visit<'_>>,
        kept: Option<&mut Deformed>,
    ) -> (Strain, usize) {
        let fibres = of.fibres.map(|fibres| &fibres.0);
        let families = |row: usize, c: [f64; 6]| -> f64 {
            let families = self.stiffness.families.iter();
            families.map(|(family, from)| self.stiffness.of_family(family, c, self.direction(row, from, fibres))).sum()
        };
        let more =
            (!self.stiffness.families.is_empty()).then_some(&families as &(dyn Fn(usize, [f64; 6]) -> f64 + Sync));
        let (block, connectivity, ends) = (of.block, of.connectivity, self.stiffness.ends);
        let groups = groups.start..groups.end.min(block.count.div_ceil(LANES));
        macro_rules! run {
            ($T:ty) => {{
                let (displacement, step, rest_shape) = (of.u.slice(), of.d.slice(), of.shape.slice());
                let columns = StrainColumns::<$T> { displacement, step, connectivity, rest_shape, ends };
                let Some(kept) = kept else {
                    return with_element_of!(block, E => strains::<E, $T>(of.cpu, &columns, groups, more, visit, None));
                };
                let [mut size, mut squeeze] = [[<$T>::default(); ROWS_A_PART]; 2];
                let mut of_more = [0.0; ROWS_A_PART];
                let rows = groups.len() * LANES;
                let own = Kept { size: &mut size, squeeze: &mut squeeze, more: &mut of_more };
                let found = with_element_of!(block, E => strains::<E, $T>(of.cpu, &columns, groups, more, visit, Some(own)));
                // what is no number is beyond all numbers
                let number = |of: &$T| if of.is_finite() { f64::from(*of) } else { f64::INFINITY };
                kept.size.extend(size[..rows].iter().map(number));
                kept.squeeze.extend(squeeze[..rows].iter().map(number));
                kept.more.extend(&of_more[..rows]);
                found
            }};
        }
        match of.u.0 {
            Reals::F32(_) => run!(f32),
            Reals::F64(_) => run!(f64),
        }
    }

    fn direction(&self, row: usize, from: &FamilyDirection<f64>, fibres: Option<&Reals>) -> [f64; 3] {
        match (from, fibres) {
            (FamilyDirection::Uniform(a), _) => *a,
            (FamilyDirection::Varying(place), Some(all)) => {
                let numbers = 3 * self.stiffness.varying;
                [0, 1, 2].map(|i| all.get(lane_place(row, numbers, 3 * place + i)))
            }
            (FamilyDirection::Varying(_), None) => [0.0; 3],
        }
    }
}
