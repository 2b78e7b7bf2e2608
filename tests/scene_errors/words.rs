//! Texts that are not RON, and words that no scene has.

use crate::good::compare;

#[test]
fn text_that_is_not_ron_is_marked_where_it_goes_wrong() {
    compare(&[
        ("duration: 0.5,", "duration: 0.5", r"4:5: error: a comma is missing | expected a comma here"),
        (
            "duration: 0.5,",
            "duration = 0.5,",
            r"3:14: error: `=` does not belong here | a colon stands between name and value",
        ),
        ("duration: 0.5,", "duration 0.5,", r"3:13: error: a colon is missing | expected a colon here"),
        ("duration: 0.5,", "duration: ,", r"3:15: error: a value is missing | expected a value before this"),
        (
            "duration: 0.5,",
            "duration: 0.5, /* no end",
            r"3:20: error: this comment has no end; close it with */ | begins here",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, ]",
            r"3:20: error: `]` does not match the bracket that is open | expected `)` | opened here",
        ),
        (
            r#"title: "A cube under gravity""#,
            r#"title: "A cube\q""#,
            r"2:12: error: this text cannot be read: Unknown escape character | write \\ for a backslash",
        ),
        (
            r#"title: "A cube under gravity""#,
            r#"title: "A cube"#,
            r"2:12: error: this text does not end on its line; a quotation mark may be missing | begins here",
        ),
        (
            "    },\n)\n",
            "    },\n",
            r"21:7: error: the file ends too early | the end of the file | this bracket is not closed",
        ),
        (")\n", "x)\n", r"22:1: error: the field x has no value | expected a colon after this"),
        ("duration: 0.5,", "duration: 0.5; ", r"3:18: error: `;` does not belong here | expected a comma or `)`"),
        ("duration: 0.5,", "duration: &,", r"3:15: error: `&` does not belong here | expected a value"),
        (
            "    },\n)\n",
            "    },\n)\n)",
            r"23:1: error: something follows after the end of the scene | the scene is complete before this",
        ),
        (
            "bodies: {\n        \"cube\"",
            "bodies: {\n        \"cube\" \"x\"",
            r"8:15: error: a colon is missing | expected a colon here
8:19: error: `:` does not belong here | expected a comma or `}`",
        ),
    ]);
}

#[test]
fn words_that_do_not_fit_are_told_with_those_that_do() {
    compare(&[
        (
            "duration: 0.5,",
            "duratoin: 0.5,",
            r"3:5: error: unknown field `duratoin` | not a field of Scene | did you mean `duration`? | allowed: title, duration, analysis, solver, start, parts, bodies, materials, constraints, loads, tools, contacts, suction, attachments, systems, removal, probes, integration, schedule, real_time, fuse, parameters, output, guards and 2 more",
        ),
        (
            "duration: 0.5,",
            "",
            r"1:1: error: the field `duration` is missing in the scene | Scene needs `duration` | duration: Simulated time (s); the time whose loads and motions a static analysis takes. A file without it may be a part of a scene: see `parts`.",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, colour: 3,",
            r"3:20: error: unknown field `colour` | not a field of Scene | allowed: title, duration, analysis, solver, start, parts, bodies, materials, constraints, loads, tools, contacts, suction, attachments, systems, removal, probes, integration, schedule, real_time, fuse, parameters, output, guards and 2 more",
        ),
        ("duration: 0.5,", r#"duration: "0.5","#, r"3:15: error: `duration` must be a number | found a text"),
        ("duration: 0.5,", "duration: 1.2.3,", r"3:15: error: `1.2.3` is not a number | written like 0.05, 5e-2 or 3"),
        (
            "duration: 0.5,",
            "duration: 0.5 s,",
            r"3:19: error: `s` does not belong here | numbers are written without units: m, kg, s, Pa",
        ),
        (
            "duration: 0.5,",
            "duration: inf,",
            r"3:15: error: `duration` must be finite, found inf | not a finite number",
        ),
        (
            "duration: 0.5,",
            "duration: Some(1.0),",
            r"3:15: error: `duration` must be a number | found a word with brackets",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, duration: 1,",
            r"3:20: error: `duration` stands here twice | the second time | the first time | keep one of the two",
        ),
        ("(4, 4, 4)", "(4, 4)", r"9:53: error: `cells` must have 3 values, found 2 | 3 values belong here"),
        ("(4, 4, 4)", "(4.0, 4, 4)", r"9:54: error: `cells` must be a whole number, 0 or above, found 4.0 | write 4"),
        (
            "(4, 4, 4)",
            "(4.5, -4, 5000000000)",
            r"9:54: error: `cells` must be a whole number, 0 or above, found 4.5
9:59: error: `cells` must be a whole number, 0 or above, found -4
9:63: error: `cells` must be at most 4294967295, found 5000000000 | too large",
        ),
        ("(4, 4, 4)", "[4, 4, 4]", r"9:53: error: `cells` must stand in round brackets | write ( ) instead of [ ]"),
        ("(4, 4, 4)", "4", r"9:53: error: `cells` must be 3 values in round brackets | found a number"),
        (
            "Hex8",
            "hex8",
            r"9:74: error: `elements` cannot be `hex8` | unknown word | did you mean `Hex8`? | allowed: {elements}",
        ),
        ("Hex8", "Hex20", r"9:74: error: `elements` cannot be `Hex20` | unknown word | allowed: {elements}"),
        ("Hex8", r#""Hex8""#, r"9:74: error: `elements` must be a word without quotes | write Hex8"),
        ("Hex8", "Hex8()", r"9:74: error: `Hex8` stands alone, without brackets | write Hex8"),
        ("Hex8", "8", r"9:74: error: `elements` must be one of the words below | found a number | allowed: {elements}"),
        (
            "Box(size",
            "Bx(size",
            r"9:19: error: `mesh` cannot be `Bx` | unknown word | did you mean `Box`? | allowed: File, Box, Cylinder, Ellipsoid, Hexahedron, Tube, Lens",
        ),
        (
            "mesh: Box",
            "mesh: ",
            r"9:19: error: `mesh` must be one of the words below | found fields in brackets ( ) | allowed: File, Box, Cylinder, Ellipsoid, Hexahedron, Tube, Lens",
        ),
        (
            r#"material: "tissue""#,
            "material: tissue",
            r#"10:23: error: `material` must be a text in quotes | write "tissue""#,
        ),
        (r#"material: "tissue""#, "material: 3", r"10:23: error: `material` must be a text in quotes | found a number"),
        (r#"material: "tissue""#, "", r"10:13: error: the name of a field is missing | expected `name: value`"),
        (r#""cube": ("#, "cube: (", r#"8:9: error: the names in `bodies` must be texts in quotes | write "cube""#),
        (r#""tissue": ("#, r#""tissue": Material("#, ""),
        (
            r#""tissue": ("#,
            r#""tissue": Stuff("#,
            r"5:19: error: `Stuff` does not belong here | `tissue` is written without a word before the brackets
5:53: error: the material `tissue` has no elastic law | add for instance neo_hookean: Young(young: 3000, poisson: 0.45) | elastic laws: {laws}",
        ),
        (
            "    loads: [\n",
            "    loads: (\n",
            r"18:5: error: `]` does not match the bracket that is open | expected `)` | opened here",
        ),
        (
            "Young(young: 3e3, poisson: 0.45)",
            "Young",
            r"5:48: error: `Young` needs brackets | write Young(...) | fields: young, poisson",
        ),
        (
            "Young(young: 3e3, poisson: 0.45)",
            "(young: 3e3, poisson: 0.45)",
            r"5:48: error: `neo_hookean` must be one of the words below | found fields in brackets ( ) | allowed: Young, Moduli",
        ),
        (
            "Young(young: 3e3, poisson: 0.45)",
            "Moduli(shear: 1, poisson: 0.45)",
            r"5:48: error: the field `bulk` is missing in `Moduli` | Moduli needs `bulk` | bulk: Bulk modulus κ (Pa).
5:65: error: unknown field `poisson` | not a field of Moduli | allowed: shear, bulk",
        ),
        (
            "Young(young: 3e3, poisson: 0.45)",
            "Young(3e3, 0.45)",
            r"5:48: error: `Young` needs the names of its fields | write Young(young: ...) | fields: young, poisson",
        ),
        (
            r#""cube": ("#,
            r#" "cube": (mesh: File(path: "a.msh"), material: "x"), "cube": ("#,
            r"8:36: error: there is no file `a.msh` | no mesh files (.msh, .vtk, .vtu) in this folder; paths are relative to the scene file
8:56: error: there is no material `x` | allowed: tissue
8:62: error: `cube` stands here twice | the second time | the first time | keep one of the two",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: All, axes: X)",
            r"14:30: error: `axes` must be a list | write [X]",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: All, axes: (X, Y))",
            r"14:30: error: `axes` must be a list | write [ ] instead of ( )",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: All, axes: [x])",
            r"14:31: error: `axes` cannot be `x` | unknown word | did you mean `X`? | allowed: X, Y, Z",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Surface)",
            r"14:19: error: `Surface` needs brackets | write Surface(...) | fields: normal, within",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Nodes)",
            r"14:19: error: `Nodes` needs one value in brackets | write Nodes(...)",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Nodes(1))",
            r"14:25: error: `Nodes` must be a list | write [1]",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: Nodes([1.5]))",
            r"14:26: error: `Nodes` must be a whole number, 0 or above, found 1.5",
        ),
        (
            "Fixed(on: Plane(normal: (0, 0, 1), at: 0.0))",
            "Fixed(on: All, axis: [X])",
            r"14:24: error: unknown field `axis` | not a field of Fixed | did you mean `axes`? | allowed: body, on, axes",
        ),
        (
            r#""tip": (what: Displacement, on: Surface(normal: (0, 0, 1)))"#,
            r#""tip": (what: Displacment, on: All)"#,
            r"20:23: error: `what` cannot be `Displacment` | unknown word | did you mean `Displacement`? | allowed: Displacement, Position, Velocity, Reaction, Force, Moment, Torque, Stress, VolumeRatio, RemovedVolume, ContactForce, ContactPressure, ContactArea, ContactGap, ContactSlip, AttachmentForce, SutureLength, ToolForce, ToolTorque, ToolPlace, ToolPose, ToolVelocity",
        ),
        (
            r#""tip": (what: Displacement, on: Surface(normal: (0, 0, 1)))"#,
            r#""tip": (what: Stress)"#,
            r"20:16: error: the probe `tip` lacks `on`: which nodes or elements it is of | on: All, Set(...), Plane(...), ...",
        ),
        (
            "probes: {",
            "probes: (",
            r"20:14: error: `:` does not belong here | names in quotes belong in curly brackets { }",
        ),
        (
            "duration: 0.5,",
            "duration: 0.5, integration: (compensated: 1, step: x),",
            r"3:47: error: `compensated` must be true or false | found a number
3:56: error: `step` must be a number | found a word",
        ),
        (
            "duration: 0.5,",
            r#"duration: 0.5, parameters: {"wind": (speed: 3, 4)},"#,
            r"3:52: error: the name of a field is missing | expected `name: value`",
        ),
    ]);
}
