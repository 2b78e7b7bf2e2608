//! Data appended behind the XML of a file.

use crate::read::Fault;

/// A file in two parts.
pub struct Split<'a> {
    /// The XML, its `AppendedData` closed at once.
    pub xml: String,
    /// What follows the underscore in `AppendedData`, up to its end.
    pub data: &'a [u8],
    /// Whether `data` is base64 and not raw.
    pub base64: bool,
}

/// Takes appended data out of the file, so that the rest is XML whatever bytes the data hold.
pub fn split(bytes: &[u8]) -> Result<Split<'_>, Fault> {
    let find = |what: &[u8], from: usize| {
        bytes.get(from..)?.windows(what.len()).position(|window| window == what).map(|at| from + at)
    };
    let text = |bytes: &[u8]| {
        String::from_utf8(bytes.to_vec()).map_err(|error| {
            let what = format!("byte {} is not text", error.utf8_error().valid_up_to());
            Fault::whole(what, "outside its appended data a VTU file is UTF-8 text")
        })
    };
    let Some(start) = find(b"<AppendedData", 0) else {
        return Ok(Split { xml: text(bytes)?, data: &[], base64: false });
    };
    let cut =
        || Fault::whole("AppendedData is cut short", "it begins with an underscore and ends with </AppendedData>");
    let tag_end = find(b">", start).ok_or_else(cut)?;
    let data = find(b"_", tag_end).ok_or_else(cut)? + 1;
    let end = bytes
        .windows(15)
        .rposition(|window| window == b"</AppendedData>")
        .filter(|&end| end >= data)
        .ok_or_else(cut)?;
    let tag = text(&bytes[start..tag_end])?;
    let xml = text(&bytes[..=tag_end])? + &text(&bytes[end..])?;
    let base64 = tag.contains("base64");
    if !base64 && !tag.contains("raw") {
        return Err(Fault::whole(format!("{tag}> has an unknown encoding"), "it must be raw or base64"));
    }
    Ok(Split { xml, data: &bytes[data..end], base64 })
}
