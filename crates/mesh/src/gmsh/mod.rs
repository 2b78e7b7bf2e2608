//! Gmsh files: format 1, formats 2.x and 4.1 as text or binary.

mod data;
mod groups;
mod kinds;
mod version1;
mod version2;
mod version4;

use super::read::Fault;
use super::read::cursor::{Cursor, Form};
use super::read::draft::Draft;
use groups::Groups;

const VERSIONS: &str = "sinew reads the formats 1, 2.0 to 2.2 and 4.1 (in Gmsh: -format msh41 or msh22)";

/// What is read so far.
struct File<'a> {
    cursor: Cursor<'a>,
    draft: Draft,
    groups: Groups,
    /// The format's first digit.
    version: u32,
    /// Bytes of an unsigned integer in format 4.
    width: usize,
    binary: Form,
}

/// Reads a file from its first word.
pub(super) fn read(cursor: Cursor) -> Result<Draft, Fault> {
    let draft = Draft::numbered();
    let mut file = File { cursor, draft, groups: Groups::default(), version: 1, width: 8, binary: Form::Text };
    while let Some(word) = file.cursor.try_word() {
        let Some(name) = word.strip_prefix(b"$") else {
            let found = String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned();
            let allowed = "a section such as $Nodes begins here; counts of the section before may be wrong";
            return Err(file.cursor.fault(format!("`{found}` between sections"), allowed));
        };
        let name = String::from_utf8_lossy(name).into_owned();
        file.section(&name)?;
    }
    Ok(file.draft)
}

impl File<'_> {
    fn section(&mut self, name: &str) -> Result<(), Fault> {
        match (name, self.version) {
            ("MeshFormat", _) => self.format()?,
            ("NOD", 1) => self.nodes1()?,
            ("ELM", 1) => self.elements1()?,
            ("PhysicalNames", 2 | 4) => self.groups.read_names(&mut self.cursor)?,
            ("Nodes", 2) => self.in_binary(Self::nodes2)?,
            ("Elements", 2) => self.in_binary(Self::elements2)?,
            ("Entities", 4) => self.in_binary(Self::entities4)?,
            ("Nodes", 4) => self.in_binary(Self::nodes4)?,
            ("Elements", 4) => self.in_binary(Self::elements4)?,
            ("ElementData", 2 | 4) => self.element_data()?,
            ("Nodes" | "Elements", _) => {
                return Err(self.cursor.fault(format!("${name} before $MeshFormat"), "the format must be known first"));
            }
            (other, _) => {
                if other == "PartitionedEntities" {
                    self.draft.notes.push("the mesh is partitioned; groups of its parts are left out".into());
                }
                let end = format!("$End{other}");
                if !self.cursor.skip_behind(&end) {
                    return Err(self
                        .cursor
                        .fault(format!("${other} has no {end}"), "the file may have been cut short"));
                }
                return Ok(());
            }
        }
        let (end, what) = match name {
            "NOD" | "ELM" => (format!("$END{name}"), "a line too many"),
            _ => (format!("$End{name}"), "more than claimed"),
        };
        self.cursor.expect(&end, &format!("the section's count must fit what it holds; this would be {what}"))
    }

    /// Runs a part whose numbers are binary in a binary file.
    fn in_binary(&mut self, read: fn(&mut Self) -> Result<(), Fault>) -> Result<(), Fault> {
        if self.version == 4 && self.binary != Form::Text {
            self.cursor.skip_line_break();
        }
        if self.version == 4 {
            self.cursor.form = self.binary;
        }
        read(self)?;
        self.cursor.form = Form::Text;
        Ok(())
    }

    fn format(&mut self) -> Result<(), Fault> {
        let version = self.cursor.name("the format's version")?;
        self.version = match version.as_str() {
            "2" | "2.0" | "2.1" | "2.2" => 2,
            "4.1" => 4,
            _ => return Err(self.cursor.fault(format!("Gmsh format {version}"), VERSIONS)),
        };
        let binary: u32 = self.cursor.number("0 for text or 1 for binary")?;
        if binary > 1 {
            return Err(self.cursor.fault(format!("file type {binary}"), "0 is text, 1 is binary"));
        }
        self.width = self.cursor.number("the size of a number")?;
        let widths: &[usize] = if self.version == 2 { &[8] } else { &[4, 8] };
        if !widths.contains(&self.width) {
            return Err(self
                .cursor
                .fault(format!("data size {}", self.width), format!("it must be one of {widths:?} bytes")));
        }
        self.draft.repeats_elements = self.version == 2;
        if binary == 1 {
            self.cursor.skip_line_break();
            self.cursor.form = Form::LittleEndian;
            self.binary = match self.cursor.int("the number 1")? {
                1 => Form::LittleEndian,
                0x0100_0000 => Form::BigEndian,
                other => {
                    let allowed = "it is 1 in one of the two byte orders; was the file changed as if it were text?";
                    return Err(self.cursor.fault(format!("{other} where the number 1 should be"), allowed));
                }
            };
            self.cursor.form = Form::Text;
        }
        Ok(())
    }

    /// Adds a node.
    fn node(&mut self, number: u64, point: glam::DVec3) {
        if let Some(numbers) = &mut self.draft.point_numbers {
            numbers.push(number);
        }
        self.draft.points.push(point);
    }
}
