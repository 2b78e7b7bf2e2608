//! Values that no scene can have.

use crate::good::compare;

#[test]
fn names_must_exist_and_be_fit_for_files() {
    compare(&[
        (
            r#"material: "tissue""#,
            r#"material: "tisue""#,
            r"5:19: warning: no body uses the material `tissue`
10:23: error: there is no material `tisue` | did you mean `tissue`? | allowed: tissue",
        ),
        (
            r#"material: "tissue""#,
            r#"material: "bone""#,
            r"5:19: warning: no body uses the material `tissue`
10:23: error: there is no material `bone` | allowed: tissue",
        ),
        (
            "materials: {",
            r#"materials: { "bone": (density: 1, neo_hookean: Moduli(shear: 1, bulk: 10)),"#,
            r"4:26: warning: no body uses the material `bone`",
        ),
        (
            "on: Surface",
            r#"body: "cub", on: Surface"#,
            r"20:43: error: there is no body `cub` | did you mean `cube`? | allowed: cube",
        ),
        (
            "bodies: {",
            r#"bodies: { "ball": (mesh: Ellipsoid(radii: (1, 1, 1), across: 4), material: "tissue"),"#,
            r"14:9: error: which body? The scene has 2 | needs `body` | bodies: ball, cube
20:16: error: which body? The scene has 2 | needs `body` | bodies: ball, cube",
        ),
        (
            r#""tip""#,
            r#""tip/1""#,
            r"20:18: error: the probe `tip/1` needs another name: files are named after it | letters, digits, _ and - do everywhere",
        ),
        (
            r#""tip""#,
            r#""tip of it""#,
            r"20:22: warning: the name of the probe `tip of it` is awkward in files and tables | letters, digits, _ and - do everywhere",
        ),
        (
            r#""cube""#,
            r#""""#,
            r"8:13: error: the body `` needs another name: files are named after it | letters, digits, _ and - do everywhere",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, schedule: [],",
            r"3:30: error: the schedule is empty: nothing would happen | leave `schedule` out to have it derived from the scene",
        ),
        (
            "\"cube\": (\n            mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8),\n            material: \"tissue\",\n        ),",
            "",
            r#"5:19: warning: no body uses the material `tissue`
7:13: error: the scene has no body | a body: "cube": (mesh: ..., material: ...)"#,
        ),
    ]);
}

#[test]
fn materials_that_cannot_be_are_refused_with_the_reason() {
    compare(&[
        ("density: 1060", "density: 0", r"5:29: error: `density` must be above 0, found 0 kg/m³"),
        ("density: 1060", "density: -1060", r"5:29: error: `density` must be above 0, found -1060 kg/m³"),
        (
            "density: 1060",
            "density: 1e31",
            r"5:29: error: `density` is too large: 1e31 | numbers up to 1e30 are allowed: the engine computes in single precision",
        ),
        (
            ", neo_hookean: Young(young: 3e3, poisson: 0.45)",
            "",
            r"5:19: error: the material `tissue` has no elastic law | add for instance neo_hookean: Young(young: 3000, poisson: 0.45) | elastic laws: {laws}",
        ),
        ("young: 3e3", "young: 0", r"5:61: error: `young` must be above 0, found 0 Pa"),
        (
            "0.45",
            "0.5",
            r"5:75: error: `poisson` must be between -1 and 0.5, found 0.5 | 0.5 means no change of volume at all: an infinite bulk modulus, and a stable step of 0 | soft tissue is usually given 0.45 to 0.499",
        ),
        (
            "0.45",
            "-1",
            r"5:75: error: `poisson` must be between -1 and 0.5, found -1 | at -1 and below the bulk modulus is infinite or negative",
        ),
        (
            "Young(young: 3e3, poisson: 0.45)",
            "Moduli(shear: 0, bulk: -1)",
            r"5:62: error: `shear` must be above 0, found 0 Pa
5:71: error: `bulk` must be above 0, found -1 Pa",
        ),
        (
            "Young(young: 3e3, poisson: 0.45)",
            "Moduli(shear: 3000, bulk: 1000)",
            r"5:74: warning: `bulk` is small: Poisson's ratio is -0.250 | Poisson's ratio is above 0 when `bulk` is above 2/3 `shear`, here 2000",
        ),
        (
            "density: 1060",
            "fibres: (eta: -1, direction: Along(0, 0, 0)), density: 1",
            r"5:34: error: `eta` must be 0 or above, found -1 Pa
5:49: error: fibres along (0, 0, 0) have no direction",
        ),
        (
            "density: 1060",
            "fibres: (eta: 1, direction: Around(axis: (0, 0, 0))), density: 1",
            r"5:61: error: `axis` has no direction: its length is 0 | its length does not matter, but it must point somewhere: (0, 0, 1)",
        ),
        (
            "density: 1060",
            r#"fibres: (eta: 1, direction: Field("f")), density: 1"#,
            r"5:48: error: the mesh of `cube` has no cell data `f`: it is generated | allowed for generated meshes: Along(x, y, z), Around(center: ..., axis: ...)",
        ),
        (
            "density: 1060",
            "prony: (terms: []), density: 1",
            r"5:35: error: `prony` has no terms | add (alpha: ..., tau: ...), or leave `prony` out",
        ),
        (
            "density: 1060",
            "prony: (terms: [(alpha: 0.7, tau: 0), (alpha: 0.3, tau: 1)]), density: 1",
            r"5:35: error: the `alpha` of all terms must be below 1 together, found 1 | 1 minus their sum is the share of the stress that remains for ever
5:54: error: `tau` must be above 0, found 0 s",
        ),
        (
            "density: 1060",
            "prony: (terms: [(alpha: -0.1, tau: 1)]), density: 1",
            r"5:44: error: `alpha` must be 0 or above, found -0.1",
        ),
        ("density: 1060", "density: 1, damping: -1", r"5:41: error: `damping` must be 0 or above, found -1 s⁻¹"),
    ]);
}

#[test]
fn bodies_selections_and_pictures_are_checked() {
    compare(&[
        (
            "(0.1, 0.1, 0.1)",
            "(0.1, 0, -0.1)",
            r"9:35: error: `size` must be above 0, found 0 m
9:38: error: `size` must be above 0, found -0.1 m",
        ),
        ("(4, 4, 4)", "(4, 0, 4)", r"9:57: error: `cells` must be 1 or more, found 0"),
        (
            "(4, 4, 4)",
            "(2000, 2000, 2000)",
            r"9:53: error: the mesh would have 8000000000 elements: 8000000000 cells | at most 100000000 elements are allowed in all bodies together",
        ),
        (r#"material: "tissue""#, r#"material: "tissue", scale: 0"#, r"10:40: error: `scale` must be above 0, found 0"),
        (
            "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)",
            "mesh: Cylinder(radius: 0, height: -1, across: 0, along: 4)",
            r"9:36: error: `radius` must be above 0, found 0 m
9:47: error: `height` must be above 0, found -1 m
9:59: error: `across` must be 1 or more, found 0",
        ),
        (
            "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)",
            "mesh: Lens(diameter: 0.01, thickness: 0.02, across: 8, through: 4)",
            r"9:51: error: `thickness` must be at most the diameter, found 0.02 m | `diameter` is 0.01 m; a lens as thick as wide is a ball",
        ),
        (
            "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)",
            "mesh: Tube(inner: 0.02, outer: 0.01, height: 0, angle: 270, cells: (4, 1, 0))",
            r"9:44: error: `outer` must be more than `inner`, found 0.01 m | `inner` is 0.02 m
9:58: error: `height` must be above 0, found 0 m
9:84: error: `cells` must be 2 or more for an angle of 270 degrees, found 1 | a cell turns by less than 180 degrees
9:87: error: `cells` must be 1 or more, found 0",
        ),
        (
            "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)",
            "mesh: Tube(inner: 0.01, outer: 0.02, height: 1, angle: 361, cells: (4, 8, 1))",
            r"9:68: error: `angle` must be above 0 and at most 360 degrees, found 361",
        ),
        (
            "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)",
            "mesh: Ellipsoid(radii: (1, 1, 0), across: 2000)",
            r"9:43: error: `radii` must be above 0, found 0 m
9:55: error: the mesh would have 48000000000 elements: 8000000000 cells | at most 100000000 elements are allowed in all bodies together",
        ),
        (
            "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)",
            r#"mesh: File(path: "")"#,
            r"9:30: error: the path of the mesh file is empty",
        ),
        (
            "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)",
            r#"mesh: File(path: "no/where.msh")"#,
            r"9:30: error: there is no file `no/where.msh` | no mesh files (.msh, .vtk, .vtu) in the folder `no`; paths are relative to the scene file",
        ),
        (
            "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)",
            r#"mesh: File(path: "src")"#,
            r"9:30: error: `src` is a folder, not a mesh file",
        ),
        (
            "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)",
            r#"mesh: File(path: "Cargo.toml")"#,
            r"9:30: error: `Cargo.toml` is no mesh file that can be read | allowed: Gmsh (.msh), legacy VTK (.vtk), VTU (.vtu)",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Plane(normal: (0, 0, 0), at: 0, tolerance: -1))",
            r"14:33: error: `normal` has no direction: its length is 0 | its length does not matter, but it must point somewhere: (0, 0, 1)
14:62: error: `tolerance` must be 0 or above, found -1 m",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Box(min: (0, 1, 0), max: (1, 0, 1)))",
            r"14:32: error: the box is empty: in y, `min` is 1 and `max` 0",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Sphere(center: (0, 0, 0), radius: 0))",
            r"14:53: error: `radius` must be above 0, found 0 m",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Surface(normal: (0, 0, 0), within: 200))",
            r"14:35: error: `normal` has no direction: its length is 0 | its length does not matter, but it must point somewhere: (0, 0, 1)
14:54: error: `within` must be above 0 and at most 180 degrees, found 200",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Nodes([]))",
            r"14:19: error: `Nodes` has an empty list: it selects nothing",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: And([]))",
            r"14:19: error: `And` has an empty list: it selects nothing",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Or([All, Not(Sphere(center: (0, 0, 0), radius: -1))]))",
            r"14:66: error: `radius` must be above 0, found -1 m",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            r#"Fixed(on: Set(""))"#,
            r"14:19: error: the name of the set is empty",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: All, axes: [])",
            r"14:30: error: the list of `axes` is empty: nothing would be held | leave `axes` out for all three, or name some of X, Y, Z",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: All, axes: [X, X])",
            r"14:34: warning: the axis X stands here twice",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Prescribed(on: All)",
            r"14:9: warning: this prescribes no motion: it holds the nodes as `Fixed` does | give `displacement`, `gradient` or `rotation`",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, picture: (size: (319, 10000), from: (0, 0, 0)),",
            r"3:37: error: `size` must be from 320 to 8192 pixels wide, found 319
3:42: error: `size` must be from 240 to 8192 pixels high, found 10000
3:56: error: `from` has no direction: its length is 0 | its length does not matter, but it must point somewhere: (0, 0, 1)",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, picture: (up: (0, 0, 0), zoom: -1, range: (2, 1), cut: (point: (0, 0, 0), normal: (0, 0, 0))),",
            r"3:34: error: `up` has no direction: its length is 0 | its length does not matter, but it must point somewhere: (0, 0, 1)
3:51: error: `zoom` must be from 0.01 to 1000, found -1
3:62: error: `range` is empty: from 2 to 1 | the value of the first colour, and a larger one of the last: (0, 0.02), in the field's SI unit
3:102: error: `normal` has no direction: its length is 0 | its length does not matter, but it must point somewhere: (0, 0, 1)",
        ),
        (
            "duration: 0.5,",
            r#"duration: 0.5, picture: (opacity: [(body: "cub", opacity: 0.5), (material: "bone", opacity: 1.5)]),"#,
            r"3:47: error: there is no body `cub` | did you mean `cube`? | allowed: cube
3:80: error: there is no material `bone` | allowed: tissue
3:97: error: `opacity` must be between 0 and 1, found 1.5",
        ),
        (
            r#"material: "tissue""#,
            r#"material: "tissue", regions: [(on: Elements([]), material: "tissue")]"#,
            r"10:48: error: `Elements` has an empty list: it selects nothing",
        ),
    ]);
}

#[test]
fn times_and_curves_are_checked() {
    compare(&[
        ("0.5,", "0,", r"3:15: error: `duration` must be above 0, found 0 s"),
        (
            "duration: 0.5,",
            "duration: 0.5, output: (fields: [Displacement, Reaction, FibreStretch, Reaction]),",
            r"3:62: error: no material has fibres whose stretch could be written | add `fibres` or `exponential_fibres` to a material, or leave `FibreStretch` out
3:76: error: `Reaction` is there twice | name each field once",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, output: (fields: [Displacement]), picture: (field: VonMises),",
            r"3:37: warning: `sinew render` would not find the scene's `picture: (field: VonMises)`: `VonMises` is not among `fields` | add it, if you want pictures",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, integration: (step: 0, safety: 1.5),",
            r"3:40: error: `step` must be above 0, found 0 s
3:51: error: `safety` must be above 0 and at most 1, found 1.5 | it is the share of the stable step that is taken; 0.9 when left out",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, integration: (safety: 0),",
            r"3:42: error: `safety` must be above 0 and at most 1, found 0 | it is the share of the stable step that is taken; 0.9 when left out",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, integration: (when_unstable: ScaleMass(most: -0.1)),",
            r"3:65: error: `most` must be above 0 and at most 1, found -0.1 | it is the share of all mass that may be added; 0.05 when left out",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, output: (fields_every: 0, energies_every: -1),",
            r"3:43: error: `fields_every` must be above 0, found 0 s
3:62: error: `energies_every` must be above 0, found -1 s",
        ),
        ("what: Displacement", "every: 0, what: Displacement", r"20:24: error: `every` must be above 0, found 0 s"),
        (
            "what: Displacement",
            "every: 2, what: Displacement",
            r"20:24: warning: `every` is longer than the scene: 2 s | `duration` is 0.5 s",
        ),
        (
            "curve: Smooth(end: 0.1)",
            "curve: Smooth(start: 0.2, end: 0.1)",
            r"17:77: error: `end` must be after `start`, found 0.1 s | `start` is 0.2 s",
        ),
        (
            "curve: Smooth(end: 0.1)",
            "curve: Step(start: 0.2, end: 0.2)",
            r"17:75: error: `end` must be after `start`, found 0.2 s | `start` is 0.2 s",
        ),
        (
            "curve: Smooth(end: 0.1)",
            "curve: Ramp(start: 3, end: 4)",
            r"17:65: warning: this begins at 3 s, when the scene is over | `duration` is 0.5 s",
        ),
        (
            "curve: Smooth(end: 0.1)",
            "curve: Table([])",
            r"17:53: error: the table has no points | a point is (time, factor): Table([(0, 0), (0.1, 1)])",
        ),
        (
            "curve: Smooth(end: 0.1)",
            "curve: Table([(0, 0), (0.1, 1), (0.1, 2)])",
            r"17:79: error: the times of a table must grow, found 0.1 s | the point before is at 0.1 s",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, removal: [(when: At(-1)), (when: At(9))],",
            r"3:40: error: `At` must be 0 or above, found -1 s
3:56: warning: this begins at 9 s, when the scene is over | `duration` is 0.5 s",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, removal: [(when: During(start: 0.2, end: 0.1))],",
            r"3:61: error: `end` must be after `start`, found 0.1 s | `start` is 0.2 s",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, removal: [(when: StretchAbove(0.9)), (when: VolumeRatioBelow(0)), (when: VolumeRatioAbove(0.5)), (when: EnergyDensityAbove(-1))],",
            r"3:50: warning: `StretchAbove` of 0.9 holds at rest: all elements go at once | at rest the stretch and the volume ratio are 1
3:81: error: `VolumeRatioBelow` must be above 0, found 0
3:110: warning: `VolumeRatioAbove` of 0.5 holds at rest: all elements go at once | at rest the stretch and the volume ratio are 1
3:143: error: `EnergyDensityAbove` must be 0 or above, found -1",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, accuracy: (target: 5),",
            r"3:39: warning: an error of 500 % is allowed here: 5 % would be 0.05",
        ),
        (
            "duration: 0.5,",
            r#"duration: 0.5, parameters: {"wind": (speed: inf, of: [1, NaN, 1e99])},"#,
            r"3:49: error: `speed` must be finite, found inf
3:62: error: `of` must be finite, found NaN
3:67: error: `of` is too large: 1e99 | numbers up to 1e30 are allowed: the engine computes in single precision",
        ),
    ]);
}
