//! Draws the sheet of tags as a PDF page: pieces, tags, ruler and instructions.

use lizard_video::sheet::{
    CARD_MARGIN, CARD_SIZE, CELLS_PER_SIDE, DECK_TAG_EDGE, DECK_TAG_ID, FORWARD_WORD, Point,
    RULER_LENGTH, STRIP_COUNT, STRIP_SIZE, TAGS_PER_STRIP, centre_on_strip, is_white, tag_edge,
};
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str, TextStr};

/// Length of a point, the unit of PDF, mm.
const PDF_POINT_MM: f64 = 25.4 / 72.0;
/// Name of the font within the PDF.
const FONT_NAME: Name = Name(b"F1");
/// Size of the font, mm.
const FONT_SIZE_MM: f64 = 3.3;
/// Distance from one line of text to the next, mm.
const LINE_SPACING_MM: f64 = 4.7;
/// Thickness of the cut lines, mm.
const CUT_THICKNESS_MM: f64 = 0.15;
/// Thickness of the ruler and its marks, mm.
const RULER_THICKNESS_MM: f64 = 0.3;
/// Grey of the cut lines, from 0 for black to 1 for white.
const CUT_GREY: f32 = 0.6;

/// Instructions for printing, cutting and placing the sheet, printed beside the card.
const INSTRUCTIONS: [&str; 9] = [
    "1. Print at 100 % (\"actual size\"). Measure the line between the tags of a strip: if it is not 100 mm",
    "    long, give its length to lizard measure with --ruler.",
    "2. Cut along the thin lines, and leave each strip in one piece: the distance between its tags matters.",
    "3. Tape the strips flat on the floor, one on either side of the robot's path, 30 to 40 cm apart and",
    "    roughly parallel to the path. Their exact positions do not matter.",
    "4. Glue the card to stiff cardboard, and the cardboard to the board: the tag's centre above the robot's",
    "    centre, the arrow towards the head. Measure the tag's height above the floor for --height.",
    "5. Record from above with a camera that stands still and sees all five tags the whole time. Start before",
    "    the robot moves, and record five to ten cycles of one gait.",
];

/// A paper size in landscape format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PaperSize {
    /// 297 x 210 mm.
    #[default]
    A4,
    /// 11 x 8.5 inches.
    Letter,
}

impl PaperSize {
    /// Returns the width and the height, mm.
    fn size(self) -> [f64; 2] {
        match self {
            Self::A4 => [297.0, 210.0],
            Self::Letter => [279.4, 215.9],
        }
    }

    /// Draws the sheet of tags; returns the bytes of a PDF file.
    pub fn draw_tag_sheet(self) -> Vec<u8> {
        let [catalog, pages, page, font, content, info] = [1, 2, 3, 4, 5, 6].map(Ref::new);
        let [page_width, page_height] = self.size().map(to_pdf);
        let mut pdf = Pdf::new();
        let mut root = pdf.catalog(catalog);
        root.pages(pages);
        // Asks print dialogs not to scale the page to the paper.
        root.viewer_preferences()
            .pair(Name(b"PrintScaling"), Name(b"None"));
        root.finish();
        pdf.document_info(info)
            .title(TextStr("Tags for lizard measure"));
        pdf.pages(pages).kids([page]).count(1);
        let mut page_writer = pdf.page(page);
        page_writer.media_box(Rect::new(0.0, 0.0, page_width, page_height));
        page_writer.parent(pages).contents(content);
        page_writer.resources().fonts().pair(FONT_NAME, font);
        page_writer.finish();
        pdf.type1_font(font).base_font(Name(b"Helvetica"));
        pdf.stream(content, &draw_page(self).finish());
        pdf.finish()
    }
}

/// Converts mm to points, the unit of PDF.
fn to_pdf(mm: f64) -> f32 {
    (mm / PDF_POINT_MM) as f32
}

/// Draws the whole page.
fn draw_page(paper_size: PaperSize) -> Content {
    let mut content = Content::new();
    let [width, height] = paper_size.size();
    let left = (width - STRIP_SIZE[0]) / 2.0;
    let used_height = STRIP_COUNT as f64 * STRIP_SIZE[1] + CARD_SIZE[1];
    let mut top = f64::midpoint(height, used_height);
    for strip in 0..STRIP_COUNT {
        draw_strip(&mut content, strip, [left, top - STRIP_SIZE[1]]);
        top -= STRIP_SIZE[1];
    }
    draw_card(&mut content, [left, top - CARD_SIZE[1]]);
    let text_start = [left + CARD_SIZE[0] + 8.0, top - 8.0];
    for (i, line) in INSTRUCTIONS.iter().enumerate() {
        let y = text_start[1] - i as f64 * LINE_SPACING_MM;
        write_text(&mut content, line, [text_start[0], y]);
    }
    content
}

/// Draws a strip with its lower left corner at a position, mm.
fn draw_strip(content: &mut Content, strip: usize, [x, y]: Point) {
    draw_cut_rectangle(content, [x, y], STRIP_SIZE);
    let centre = [x + STRIP_SIZE[0] / 2.0, y + STRIP_SIZE[1] / 2.0];
    for id in strip * TAGS_PER_STRIP..(strip + 1) * TAGS_PER_STRIP {
        let [u, v] = centre_on_strip(id);
        draw_tag(content, id, [centre[0] + u, centre[1] + v]);
    }
    let ruler_start = centre[0] - RULER_LENGTH / 2.0;
    let ruler_corner = [ruler_start, centre[1] - RULER_THICKNESS_MM / 2.0];
    fill_rectangle(content, ruler_corner, [RULER_LENGTH, RULER_THICKNESS_MM]);
    for i in 0..=10 {
        // The ruler ends at the outer edges of the first and the last mark.
        let mark_x = ruler_start + f64::from(i) * (RULER_LENGTH - RULER_THICKNESS_MM) / 10.0;
        let mark_length = if i % 10 == 0 { 8.0 } else { 3.0 };
        let mark_corner = [mark_x, centre[1] - mark_length / 2.0];
        fill_rectangle(content, mark_corner, [RULER_THICKNESS_MM, mark_length]);
    }
    let text = format!(
        "strip {} of {STRIP_COUNT}: flat on the floor, beside the robot's path",
        strip + 1
    );
    write_text(content, &text, [ruler_start, centre[1] + 8.0]);
    let text = "from end to end: 100 mm";
    write_text(content, text, [ruler_start, centre[1] - 10.0]);
}

/// Draws the deck's card with its lower left corner at a position, mm.
fn draw_card(content: &mut Content, [x, y]: Point) {
    draw_cut_rectangle(content, [x, y], CARD_SIZE);
    let centre_x = x + CARD_SIZE[0] / 2.0;
    let centre_y = y + CARD_MARGIN + DECK_TAG_EDGE / 2.0;
    draw_tag(content, DECK_TAG_ID, [centre_x, centre_y]);
    // The arrow starts above the tag's white margin.
    let arrow_base = y + CARD_MARGIN + DECK_TAG_EDGE + CARD_MARGIN;
    let arrow_tip = y + CARD_SIZE[1] - 1.0;
    content.move_to(to_pdf(centre_x - 4.0), to_pdf(arrow_base + 1.0));
    content.line_to(to_pdf(centre_x + 4.0), to_pdf(arrow_base + 1.0));
    content.line_to(to_pdf(centre_x), to_pdf(arrow_tip));
    content.close_path().fill_nonzero();
    write_text(content, FORWARD_WORD, [centre_x + 6.0, arrow_base + 2.0]);
}

/// Draws a tag around its centre (mm): one black square with the white cells on it. If each black cell were drawn
/// separately, printers and viewers might leave a seam between adjacent cells.
fn draw_tag(content: &mut Content, id: usize, [x, y]: Point) {
    let cell_edge = tag_edge(id) / CELLS_PER_SIDE as f64;
    let half_edge = tag_edge(id) / 2.0;
    fill_rectangle(content, [x - half_edge, y - half_edge], [tag_edge(id); 2]);
    content.set_fill_gray(1.0);
    for row in 0..CELLS_PER_SIDE {
        let mut column = 0;
        while column < CELLS_PER_SIDE {
            let white_cells =
                (column..CELLS_PER_SIDE).take_while(|&index| is_white(id, row, index));
            let run_length = white_cells.count();
            if run_length > 0 {
                let corner = [
                    x - half_edge + column as f64 * cell_edge,
                    y + half_edge - (row + 1) as f64 * cell_edge,
                ];
                fill_rectangle(content, corner, [run_length as f64 * cell_edge, cell_edge]);
            }
            column += run_length.max(1);
        }
    }
    content.set_fill_gray(0.0);
}

/// Fills a rectangle with its lower left corner at a position, mm.
fn fill_rectangle(content: &mut Content, [x, y]: Point, [width, height]: [f64; 2]) {
    let [x, y, width, height] = [x, y, width, height].map(to_pdf);
    content.rect(x, y, width, height).fill_nonzero();
}

/// Draws the cut lines around a piece with its lower left corner at a position, mm.
fn draw_cut_rectangle(content: &mut Content, [x, y]: Point, [width, height]: [f64; 2]) {
    content
        .set_line_width(to_pdf(CUT_THICKNESS_MM))
        .set_stroke_gray(CUT_GREY);
    let [x, y, width, height] = [x, y, width, height].map(to_pdf);
    content.rect(x, y, width, height).stroke();
}

/// Writes a line of text that starts at a position, mm.
fn write_text(content: &mut Content, text: &str, [x, y]: Point) {
    content.begin_text();
    content.set_font(FONT_NAME, to_pdf(FONT_SIZE_MM));
    content.next_line(to_pdf(x), to_pdf(y));
    content.show(Str(text.as_bytes())).end_text();
}
