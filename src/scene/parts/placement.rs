//! Where a part stands: what becomes of each thing in it that has a place, a length or a direction.

use crate::math::{degrees, turned};
use crate::mesh::{angles_about_axes, rotation_about_axes};
use crate::scene::schema::{
    Attachment, Axis, Body, Constraint, Contact, Direction, Free, Load, LoadPartsMut, Material, Part, Probe, Quantity,
    Removal, Select, Start, Suction, Tool, When,
};
use glam::{DMat3, DQuat, DVec3};

/// Scale, rotation and displacement of a part, in this order.
pub struct Placement {
    scale: f64,
    /// The rotation; nothing where there is none: then numbers keep their bits.
    turn: Option<DMat3>,
    translate: DVec3,
}

impl Placement {
    /// Of a part.
    pub fn of(part: &Part) -> Self {
        let turn = (part.rotate != DVec3::ZERO).then(|| rotation_about_axes(part.rotate));
        Self { scale: part.scale, turn, translate: part.translate }
    }

    /// Whether everything stays as it is.
    pub fn is_none(&self) -> bool {
        self.scale == 1.0 && self.turn.is_none() && self.translate == DVec3::ZERO
    }

    /// Whether directions become others.
    pub fn turns(&self) -> bool {
        self.turn.is_some()
    }

    fn direction(&self, value: &mut DVec3) {
        if let Some(turn) = self.turn {
            *value = turn * *value;
        }
    }

    fn length(&self, value: &mut f64) {
        *value *= self.scale;
    }

    /// From one place to another.
    fn way(&self, value: &mut DVec3) {
        *value *= self.scale;
        self.direction(value);
    }

    fn point(&self, value: &mut DVec3) {
        self.way(value);
        *value += self.translate;
    }

    /// Angles about the axes, one after the other (degrees).
    fn angles(&self, value: &mut DVec3) {
        if let Some(turn) = self.turn {
            *value = angles_about_axes(turn * rotation_about_axes(*value));
        }
    }

    /// Axis times angle (degrees) of how something is turned; not of how it turns, which is a direction.
    fn pose(&self, value: &mut DVec3) {
        if let Some(turn) = self.turn {
            *value = degrees(DQuat::from_mat3(&turn) * turned(*value));
        }
    }

    fn gradient(&self, rows: &mut [DVec3; 3]) {
        if let Some(turn) = self.turn {
            let turned =
                turn * DMat3::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose() * turn.transpose();
            *rows = [0, 1, 2].map(|row| turned.row(row));
        }
    }

    /// The axes along which the part's axes lie now; nothing where they lie along none.
    fn axes(&self, axes: &mut [Axis]) -> Option<()> {
        const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
        let Some(turn) = self.turn else { return Some(()) };
        if ALL.iter().all(|axis| axes.contains(axis)) {
            return Some(());
        }
        for axis in axes {
            let along = turn.col(*axis as usize).to_array();
            let number = along.iter().position(|part| part.abs() > 1.0 - 1e-12)?;
            *axis = ALL[number];
        }
        Some(())
    }

    pub fn select(&self, select: &mut Select) {
        match select {
            Select::All | Select::Set(_) | Select::Nodes(_) | Select::Elements(_) => {}
            Select::Plane { normal, at, tolerance } => {
                self.direction(normal);
                *at = *at * self.scale + normal.normalize_or_zero().dot(self.translate);
                tolerance.iter_mut().for_each(|tolerance| self.length(tolerance));
            }
            Select::Box { min, max, rotate } => {
                let (mut center, half) = (min.midpoint(*max), (*max - *min) / 2.0 * self.scale);
                if self.turn.is_none() {
                    self.point(min);
                    self.point(max);
                } else {
                    self.point(&mut center);
                    (*min, *max) = (center - half, center + half);
                }
                self.angles(rotate);
            }
            Select::Sphere { center, radius } => {
                self.point(center);
                self.length(radius);
            }
            Select::Cylinder { from, to, radius } => {
                self.point(from);
                self.point(to);
                self.length(radius);
            }
            Select::Ellipsoid { center, radii, rotate } => {
                self.point(center);
                *radii *= self.scale;
                self.angles(rotate);
            }
            Select::Surface { normal, .. } => normal.iter_mut().for_each(|normal| self.direction(normal)),
            Select::And(parts) | Select::Or(parts) => parts.iter_mut().for_each(|part| self.select(part)),
            Select::Not(part) => self.select(part),
        }
    }

    pub fn body(&self, body: &mut Body) {
        self.length(&mut body.scale);
        self.angles(&mut body.rotate);
        self.point(&mut body.translate);
        self.way(&mut body.apart);
        self.direction(&mut body.velocity);
        self.direction(&mut body.spin);
        match &mut body.start {
            None => {}
            Some(Start::Affine { gradient, center }) => {
                self.gradient(gradient);
                self.point(center);
            }
            Some(Start::Scrambled { amplitude, .. }) => self.length(amplitude),
        }
        body.regions.iter_mut().for_each(|region| self.select(&mut region.on));
    }

    pub fn material(&self, material: &mut Material) {
        let fibres = material.fibres.iter_mut().map(|fibres| &mut fibres.direction);
        let families = material.exponential_fibres.iter_mut().flatten().map(|family| &mut family.direction);
        for direction in fibres.chain(families) {
            match direction {
                Direction::Along(x, y, z) => {
                    let mut along = DVec3::new(*x, *y, *z);
                    self.direction(&mut along);
                    (*x, *y, *z) = along.into();
                }
                Direction::Around { center, axis } => {
                    self.point(center);
                    self.direction(axis);
                }
                // it turns with the mesh
                Direction::Field(_) => {}
            }
        }
    }

    /// Places a constraint; nothing where it is along axes that are none of the scene's now.
    pub fn constraint(&self, constraint: &mut Constraint) -> Option<()> {
        match constraint {
            Constraint::Fixed { body: _, on, axes } => {
                self.select(on);
                self.axes(axes)
            }
            Constraint::Prescribed {
                body: _,
                on,
                axes,
                displacement,
                gradient,
                rotation,
                center,
                per_copy: _,
                curve: _,
            } => {
                self.select(on);
                self.way(displacement);
                self.gradient(gradient);
                self.direction(rotation);
                self.point(center);
                self.axes(axes)
            }
        }
    }

    pub fn load(&self, load: &mut Load) {
        let LoadPartsMut { on, amplitude, .. } = load.parts_mut();
        if let Some(on) = on {
            self.select(on);
        }
        if let Some(vector) = amplitude.direction() {
            self.direction(vector);
        }
    }

    pub fn tool(&self, tool: &mut Tool) {
        // a hand counts from where its tool is
        if self.turn.is_some() && !tool.path.is_empty() {
            // turned, they would not tell any more how often it turns between them
            tool.path = tool.places();
        }
        let Tool { shape, mesh, rounding, at, rotation, path, moves, pivot, port: _, free } = tool;
        if let Some(shape) = shape.as_mut().filter(|_| self.scale != 1.0) {
            *shape = shape.scaled(self.scale);
        }
        if let Some(mesh) = mesh {
            self.length(&mut mesh.scale);
            mesh.spacing.iter_mut().for_each(|spacing| self.length(spacing));
        }
        self.length(rounding);
        if path.is_empty() {
            self.point(at.get_or_insert_default());
            self.pose(rotation.get_or_insert_default());
        }
        let mut before = None;
        for place in path {
            self.point(&mut place.at);
            self.pose(&mut place.rotation);
            if let Some(before) = before.filter(|_| self.turn.is_some()) {
                place.rotation = nearest_turn(place.rotation, before);
            }
            before = Some(place.rotation);
        }
        pivot.iter_mut().for_each(|pivot| self.point(pivot));
        if let Some(Free { mass: _, density: _, inertia: _, velocity, spin, damping: _ }) = free {
            self.direction(velocity);
            self.direction(spin);
        }
        for part in moves {
            self.way(&mut part.displacement);
            self.direction(&mut part.rotation);
        }
    }

    pub fn contact(&self, contact: &mut Contact) {
        match contact {
            Contact::Tool { on, .. } => self.select(on),
            Contact::Between { thickness, .. } | Contact::Itself { thickness, .. } => self.length(thickness),
        }
    }

    pub fn attachment(&self, attachment: &mut Attachment) {
        match attachment {
            Attachment::Grasp { on, jaws, reach, .. } => {
                on.iter_mut().for_each(|on| self.select(on));
                // in the frame of the tool, which is placed
                jaws.iter_mut().for_each(|jaws| *jaws = jaws.scaled(self.scale));
                reach.iter_mut().for_each(|reach| self.length(reach));
            }
            Attachment::Suture { from, to, length, tighten, .. } => {
                self.point(&mut from.at);
                self.point(&mut to.at);
                length.iter_mut().for_each(|length| self.length(length));
                self.length(tighten);
            }
            Attachment::Tie { from, to, .. } => {
                self.point(&mut from.at);
                self.point(&mut to.at);
            }
            Attachment::Glue { on, onto, reach, .. } => {
                self.select(on);
                self.select(onto);
                reach.iter_mut().for_each(|reach| self.length(reach));
            }
        }
    }

    pub fn removal(&self, removal: &mut Removal) {
        self.select(&mut removal.on);
        if let When::InTool { reach, bore, crumb, .. } = &mut removal.when {
            self.length(reach);
            bore.iter_mut().for_each(|bore| self.length(bore));
            // a few elements, which are so many times as large
            crumb.iter_mut().for_each(|volume| *volume *= self.scale.powi(3));
        }
    }

    pub fn suction(&self, suction: &mut Suction) {
        self.length(&mut suction.reach);
        suction.bore.iter_mut().for_each(|bore| self.length(bore));
    }

    pub fn probe(&self, probe: &mut Probe) {
        probe.on.iter_mut().for_each(|on| self.select(on));
        match &mut probe.what {
            Quantity::Force { direction } => self.direction(direction),
            Quantity::Moment { center } => self.point(center),
            Quantity::Torque { center, axis } => {
                self.point(center);
                self.direction(axis);
            }
            Quantity::Displacement
            | Quantity::Position
            | Quantity::Velocity
            | Quantity::Reaction
            | Quantity::Stress
            | Quantity::VolumeRatio
            | Quantity::RemovedVolume
            | Quantity::ContactForce
            | Quantity::ContactPressure
            | Quantity::ContactArea
            | Quantity::ContactGap
            | Quantity::ContactSlip
            | Quantity::AttachmentForce { .. }
            | Quantity::SutureLength { .. }
            | Quantity::ToolForce { .. }
            | Quantity::ToolTorque { .. }
            | Quantity::ToolPlace { .. }
            | Quantity::ToolPose { .. }
            | Quantity::ToolVelocity { .. } => {}
        }
    }
}

/// The same rotation, axis times angle (degrees), with as many whole turns as bring it nearest to one before.
fn nearest_turn(rotation: DVec3, before: DVec3) -> DVec3 {
    let axis = rotation.try_normalize().unwrap_or_else(|| before.normalize_or_zero());
    rotation + axis * (360.0 * ((before - rotation).dot(axis) / 360.0).round())
}
