//! The panel of a scene's text: what is wrong with it is marked where it stands.

use crate::app::App;
use crate::editor::{Editor, Mistake};
use egui::text::{CCursor, CCursorRange, LayoutJob, TextFormat};
use egui::text_edit::TextEditOutput;
use egui::{Align2, Button, CollapsingHeader, Color32, ComboBox, FontId, Key, Modifiers, Panel, Rect, RichText};
use egui::{ScrollArea, Stroke, TextBuffer, TextEdit, TextStyle, Ui, pos2};

const WRONG: Color32 = Color32::from_rgb(200, 50, 40);
const DOUBTFUL: Color32 = Color32::from_rgb(190, 130, 20);
const COMMENT: Color32 = Color32::from_rgb(100, 140, 100);

fn colour(mistake: &Mistake) -> Color32 {
    if mistake.is_error { WRONG } else { DOUBTFUL }
}

impl App {
    /// The text of the scene, and what is wrong with it.
    pub(crate) fn editor_panel(&mut self, ui: &mut Ui) {
        let Some(editor) = &mut self.editor else { return };
        let mut loads = ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::Enter));
        ui.add_space(3.0);
        ui.horizontal(|ui| {
            let mut chosen = None;
            ComboBox::from_label("scene").selected_text(&editor.name).show_ui(ui, |ui| {
                for (name, text) in &editor.bundle.scenes {
                    if ui.selectable_label(*name == editor.name, name).clicked() {
                        chosen = Some((name.clone(), text.clone()));
                    }
                }
            });
            let load = ui.add(Button::new("Load")).on_hover_text("takes the scene as it stands here: ctrl + enter");
            loads |= load.clicked();
            if let Some((name, text)) = chosen {
                editor.open(name, text);
            }
        });
        files(ui, editor);
        let mut jump = None;
        if !editor.mistakes.is_empty() {
            Panel::bottom("mistakes").resizable(true).show(ui, |ui| jump = list(ui, &editor.mistakes));
        }
        ScrollArea::both().auto_shrink([false; 2]).show(ui, |ui| text(ui, editor, jump));
        // with what was typed in the same frame
        if loads {
            editor.load(&[]);
        }
    }
}

/// Files that scenes can name.
fn files(ui: &mut Ui, editor: &Editor) {
    CollapsingHeader::new(format!("Files ({})", editor.bundle.files.len())).show(ui, |ui| {
        for (name, bytes) in &editor.bundle.files {
            ui.label(format!("{name}, {} kB", bytes.len().div_ceil(1000)));
        }
        ui.weak("drop meshes, skins or scenes here");
    });
}

/// All that is wrong; where the cursor is to go, if somebody clicks.
fn list(ui: &mut Ui, mistakes: &[Mistake]) -> Option<usize> {
    let mut jump = None;
    ScrollArea::vertical().max_height(180.0).show(ui, |ui| {
        for mistake in mistakes {
            let line = RichText::new(&mistake.line).color(colour(mistake));
            let clicked = ui.link(line).clicked();
            jump = jump.or(mistake.bytes.as_ref().map(|bytes| bytes.start).filter(|_| clicked));
            mistake.notes.iter().for_each(|note| drop(ui.weak(note)));
        }
    });
    jump
}

/// The text itself; `jump`: the byte that the cursor is to go to.
fn text(ui: &mut Ui, editor: &mut Editor, jump: Option<usize>) {
    let mistakes = editor.mistakes.clone();
    let mut layouter = |ui: &Ui, text: &dyn TextBuffer, _: f32| {
        ui.fonts_mut(|fonts| fonts.layout_job(job(ui, text.as_str(), &mistakes)))
    };
    let label = ui.weak("in RON; every word: docs/scene.md").id;
    let edit = TextEdit::multiline(&mut editor.text).code_editor().desired_width(f32::INFINITY).layouter(&mut layouter);
    let mut output = edit.show(ui);
    output.response.response = output.response.response.clone().labelled_by(label);
    editor.check();
    if let Some(byte) = jump.filter(|byte| *byte <= editor.text.len()) {
        let cursor = CCursor::new(characters(&editor.text, byte));
        output.state.cursor.set_char_range(Some(CCursorRange::one(cursor)));
        output.state.clone().store(ui.ctx(), output.response.id);
        output.response.request_focus();
        ui.scroll_to_rect(place(&output, &editor.text, byte), Some(egui::Align::Center));
    }
    marks(ui, &output, &editor.text, &editor.mistakes);
}

/// How many characters stand before a byte of a text.
fn characters(text: &str, byte: usize) -> usize {
    text.get(..byte).map_or(0, |before| before.chars().count())
}

/// Where a byte of the text is on the screen.
fn place(output: &TextEditOutput, text: &str, byte: usize) -> Rect {
    let cursor = CCursor::new(characters(text, byte));
    output.galley.pos_from_cursor(cursor).translate(output.galley_pos.to_vec2())
}

/// Puts what is wrong behind the lines that it is in, and tells more of it below the mouse.
fn marks(ui: &Ui, output: &TextEditOutput, text: &str, mistakes: &[Mistake]) {
    let painter = ui.painter_at(output.text_clip_rect.intersect(ui.clip_rect()));
    let mouse = output.response.hover_pos();
    let mut lines: Vec<f32> = Vec::new();
    for mistake in mistakes {
        let Some(bytes) = mistake.bytes.clone().filter(|bytes| bytes.end <= text.len()) else { continue };
        let end = text[bytes.start..].find('\n').map_or(text.len(), |length| bytes.start + length);
        let (from, to, line_end) = (bytes.start, bytes.end.min(end), end);
        let (from, to, line_end) = (place(output, text, from), place(output, text, to), place(output, text, line_end));
        // one a line, for there is no room for more
        if !lines.contains(&line_end.min.y) {
            lines.push(line_end.min.y);
            let at = pos2(line_end.max.x + 14.0, line_end.center().y);
            painter.text(at, Align2::LEFT_CENTER, &mistake.message, FontId::proportional(12.0), colour(mistake));
        }
        let marked = from.union(to).expand(2.0);
        if mouse.is_some_and(|mouse| marked.contains(mouse)) {
            output.response.response.clone().on_hover_ui_at_pointer(|ui| {
                ui.label(&mistake.message);
                mistake.notes.iter().for_each(|note| drop(ui.weak(note)));
            });
        }
    }
}

/// The text with lines below what is wrong.
fn job(ui: &Ui, text: &str, mistakes: &[Mistake]) -> LayoutJob {
    let font_id = TextStyle::Monospace.resolve(ui.style());
    let plain = TextFormat::simple(font_id, ui.visuals().text_color());
    let marked = |mistake: &Mistake| Some((mistake.bytes.clone()?, colour(mistake)));
    let mut marked: Vec<_> = mistakes.iter().filter_map(marked).collect();
    marked.sort_by_key(|(bytes, _)| bytes.start);
    let mut job = LayoutJob { keep_trailing_whitespace: true, ..LayoutJob::default() };
    job.wrap.max_width = f32::INFINITY;
    let mut done = 0;
    for (bytes, colour) in marked {
        // the text may be another one than that which was looked at
        let fits = text.is_char_boundary(bytes.start) && text.is_char_boundary(bytes.end);
        if bytes.start < done || !fits || bytes.is_empty() {
            continue;
        }
        unmarked(&mut job, &text[done..bytes.start], &plain);
        let format = TextFormat { underline: Stroke::new(1.5, colour), color: colour, ..plain.clone() };
        job.append(&text[bytes.clone()], 0.0, format);
        done = bytes.end;
    }
    unmarked(&mut job, &text[done..], &plain);
    job
}

/// Adds text in which nothing is wrong; comments in a colour of their own.
fn unmarked(job: &mut LayoutJob, text: &str, plain: &TextFormat) {
    for line in text.split_inclusive('\n') {
        let comment = comment_start(line);
        job.append(&line[..comment], 0.0, plain.clone());
        job.append(&line[comment..], 0.0, TextFormat { color: COMMENT, ..plain.clone() });
    }
}

/// Where a comment begins in a line, or the line ends; what stands in quotes is none.
fn comment_start(line: &str) -> usize {
    let slashes = line.match_indices("//").map(|(at, _)| at);
    slashes.into_iter().find(|at| line[..*at].matches('"').count().is_multiple_of(2)).unwrap_or(line.len())
}

#[cfg(test)]
mod tests {
    use super::{characters, comment_start};

    #[test]
    fn comments_begin_at_slashes_out_of_quotes() {
        assert_eq!(comment_start("a: 1, // one"), 6);
        assert_eq!(comment_start("a: \"http://b\", // c"), 15);
        assert_eq!(comment_start("a: 1"), 4);
    }

    #[test]
    fn bytes_are_counted_in_characters() {
        assert_eq!((characters("aöb", 3), characters("aöb", 2), characters("aöb", 9)), (2, 0, 0));
    }
}
