//! Directions of the fibres in a block.

use crate::components::{FamilyDirection, Precision, Reals};
use crate::math::LANES;
use crate::math::lane_place;
use crate::mesh::Mesh;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::{Direction, Material};
use glam::DVec3;

/// Elements of a block, for which directions are wanted.
pub(super) struct Members<'a> {
    pub mesh: &'a Mesh,
    pub elements: &'a [u32],
    /// The body's name.
    pub body: &'a str,
    /// The material's name.
    pub material: &'a str,
    /// The copy of each element.
    pub copies: &'a [u32],
    /// Where the families of each copy run, where that differs.
    pub of_copies: Option<Vec<Vec<&'a Direction>>>,
}

impl Members<'_> {
    /// Where each family of the material has its direction from, and the directions of those that have one an element.
    pub fn directions(
        &self,
        material: &Material,
        precision: Precision,
        diagnostics: &mut Diagnostics,
    ) -> (Vec<FamilyDirection<f64>>, Option<Reals>) {
        let (mut families, mut varying) = (Vec::new(), Vec::new());
        for (family, (field, direction)) in super::material::directions(material).into_iter().enumerate() {
            let path = format!("materials.\"{}\".{field}.direction", self.material);
            let of_copies = self.of_copies.iter().flatten().filter_map(|of_copy| of_copy.get(family).copied());
            let of_copies: Vec<&Direction> = of_copies.collect();
            match direction {
                _ if of_copies.iter().any(|&of_copy| of_copy != direction) => {
                    families.push(FamilyDirection::Varying(varying.len()));
                    varying.push(self.of_elements(&of_copies, &path, diagnostics));
                }
                Direction::Along(x, y, z) => {
                    families.push(FamilyDirection::Uniform(DVec3::new(*x, *y, *z).normalize().to_array()));
                }
                direction => {
                    families.push(FamilyDirection::Varying(varying.len()));
                    varying.push(self.of_elements(&[direction], &path, diagnostics));
                }
            }
        }
        let numbers = 3 * varying.len();
        let mut column = Reals::zeros(precision, self.elements.len().div_ceil(LANES) * LANES * numbers);
        for (family, directions) in varying.iter().enumerate() {
            for (row, unit) in directions.iter().enumerate() {
                for i in 0..3 {
                    column.set(lane_place(row, numbers, 3 * family + i), unit[i]);
                }
            }
        }
        (families, (numbers > 0).then_some(column))
    }

    /// One unit vector an element, of one direction for all or one a copy; complaints go to `diagnostics`.
    fn of_elements(&self, directions: &[&Direction], path: &str, diagnostics: &mut Diagnostics) -> Vec<DVec3> {
        let (mesh, body) = (self.mesh, self.body);
        let mut units = Vec::with_capacity(self.elements.len());
        for (row, &element) in self.elements.iter().enumerate() {
            let direction = if let [of_all] = directions { of_all } else { directions[self.copies[row] as usize] };
            let vector = match direction {
                Direction::Along(x, y, z) => DVec3::new(*x, *y, *z),
                Direction::Around { center, axis } => {
                    let nodes = mesh.element(element as usize);
                    let centroid = nodes.iter().map(|&n| mesh.points[n as usize]).sum::<DVec3>() / nodes.len() as f64;
                    axis.cross(centroid - *center)
                }
                Direction::Field(name) => match mesh.element_vectors.get(name) {
                    Some(vectors) => vectors[element as usize],
                    None => {
                        let names: Vec<&str> = mesh.element_vectors.keys().map(String::as_str).collect();
                        let message = format!("the mesh of {body} has no vectors on elements named {name:?}");
                        diagnostics.error_at(path, message).notes(crate::scene::choice(name, names));
                        return Vec::new();
                    }
                },
            };
            units.push(vector.normalize_or_zero());
        }
        let without = |(_, unit): &(&u32, &DVec3)| **unit == DVec3::ZERO;
        let mut without = self.elements.iter().zip(&units).filter(without);
        if let Some((&first, _)) = without.next() {
            let message = format!(
                "{} elements of {body} have no fibre direction (a vector of no length), the first is {}",
                1 + without.count(),
                mesh.element_ids.of(first as usize)
            );
            diagnostics.error_at(path, message);
        }
        units
    }
}
