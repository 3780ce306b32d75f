//! The sheet of tags as a PDF page: pieces, tags, ruler and instructions.

use lizard_film::sheet::{
    CARD, CARD_MARGIN, DECK_EDGE, DECK_TAG, FORWARD_WORD, Point, RULER, SQUARES, STRIP, STRIPS,
    TAGS_ON_STRIP, edge, is_white, middle_on_strip,
};
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str, TextStr};

/// Length of a point, the unit of PDF, mm.
const POINT: f64 = 25.4 / 72.0;
const FONT: Name = Name(b"F1");
/// Font size, and distance from one line to the next, mm.
const FONT_SIZE: f64 = 3.3;
const LINE_DISTANCE: f64 = 4.7;
/// Thickness of the cut lines, and of the ruler's lines, mm.
const CUT_THICKNESS: f64 = 0.15;
const RULER_THICKNESS: f64 = 0.3;
/// Grey of the cut lines.
const CUT_GREY: f32 = 0.6;

/// Instructions to print, cut, lay and glue the sheet, printed beside the card.
const INSTRUCTIONS: [&str; 9] = [
    "1. Print at 100 % (\"actual size\"). Measure the line between the tags of a strip: if it is not 100 mm",
    "    long, tell lizard measure its length with --ruler.",
    "2. Cut along the thin lines, and leave each strip in one piece: the distance of its tags counts.",
    "3. Tape the strips flat on the floor, one on either side of the robot's way, 30 to 40 cm apart and",
    "    roughly parallel to it. Their exact places do not matter.",
    "4. Glue the card on stiff cardboard and that on the board: the middle of its tag above the middle",
    "    of the robot, the arrow to the head. Measure the height of the tag above the floor for --height.",
    "5. Film from above with a camera that stands still and sees all five tags the whole time. Begin",
    "    before the robot starts: five to ten cycles of one gait.",
];

/// A paper size of printers, in landscape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Paper {
    /// 297 x 210 mm.
    #[default]
    A4,
    /// 11 x 8.5 inches.
    Letter,
}

impl Paper {
    /// Width and height, mm.
    fn size(self) -> Point {
        match self {
            Self::A4 => [297.0, 210.0],
            Self::Letter => [279.4, 215.9],
        }
    }

    /// The sheet of tags as PDF.
    pub fn sheet(self) -> Vec<u8> {
        let [catalog, pages, page, font, content, info] = [1, 2, 3, 4, 5, 6].map(Ref::new);
        let size = self.size().map(points_of);
        let mut pdf = Pdf::new();
        let mut root = pdf.catalog(catalog);
        root.pages(pages);
        // Print dialogs may scale a page to fit the paper; this asks them not to.
        root.viewer_preferences()
            .pair(Name(b"PrintScaling"), Name(b"None"));
        root.finish();
        pdf.document_info(info)
            .title(TextStr("Tags for lizard measure"));
        pdf.pages(pages).kids([page]).count(1);
        let mut page_writer = pdf.page(page);
        page_writer.media_box(Rect::new(0.0, 0.0, size[0], size[1]));
        page_writer.parent(pages).contents(content);
        page_writer.resources().fonts().pair(FONT, font);
        page_writer.finish();
        pdf.type1_font(font).base_font(Name(b"Helvetica"));
        pdf.stream(content, &draw_page(self).finish());
        pdf.finish()
    }
}

/// Converts mm to points.
fn points_of(mm: f64) -> f32 {
    (mm / POINT) as f32
}

/// Draws the whole page.
fn draw_page(paper: Paper) -> Content {
    let mut content = Content::new();
    let [width, height] = paper.size();
    let left = (width - STRIP[0]) / 2.0;
    let used_height = STRIPS as f64 * STRIP[1] + CARD[1];
    let mut top = f64::midpoint(height, used_height);
    for strip in 0..STRIPS {
        draw_strip(&mut content, strip, [left, top - STRIP[1]]);
        top -= STRIP[1];
    }
    draw_card(&mut content, [left, top - CARD[1]]);
    let text_corner = [left + CARD[0] + 8.0, top - 8.0];
    for (i, line) in INSTRUCTIONS.iter().enumerate() {
        write(
            &mut content,
            line,
            [text_corner[0], text_corner[1] - i as f64 * LINE_DISTANCE],
        );
    }
    content
}

/// Draws a strip with its lower left corner at a point.
fn draw_strip(content: &mut Content, strip: usize, [x, y]: Point) {
    draw_cut_line(content, [x, y], STRIP);
    let middle = [x + STRIP[0] / 2.0, y + STRIP[1] / 2.0];
    for id in strip * TAGS_ON_STRIP..(strip + 1) * TAGS_ON_STRIP {
        let [u, v] = middle_on_strip(id);
        draw_tag(content, id, [middle[0] + u, middle[1] + v]);
    }
    let ruler_start = middle[0] - RULER / 2.0;
    fill(
        content,
        [ruler_start, middle[1] - RULER_THICKNESS / 2.0],
        [RULER, RULER_THICKNESS],
    );
    for i in 0..=10 {
        // The outer edges of the first and the last mark are the ends of the ruler.
        let mark_x = ruler_start + f64::from(i) * (RULER - RULER_THICKNESS) / 10.0;
        let mark_length = if i % 10 == 0 { 8.0 } else { 3.0 };
        fill(
            content,
            [mark_x, middle[1] - mark_length / 2.0],
            [RULER_THICKNESS, mark_length],
        );
    }
    let text = format!(
        "strip {} of {STRIPS}: flat on the floor, beside the robot's way",
        strip + 1
    );
    write(content, &text, [ruler_start, middle[1] + 8.0]);
    let text = "from end to end: 100 mm";
    write(content, text, [ruler_start, middle[1] - 10.0]);
}

/// Draws the deck's card with its lower left corner at a point.
fn draw_card(content: &mut Content, [x, y]: Point) {
    draw_cut_line(content, [x, y], CARD);
    let middle = x + CARD[0] / 2.0;
    draw_tag(
        content,
        DECK_TAG,
        [middle, y + CARD_MARGIN + DECK_EDGE / 2.0],
    );
    // The arrow begins beyond the white margin of the tag.
    let base = y + CARD_MARGIN + DECK_EDGE + CARD_MARGIN;
    let tip = y + CARD[1] - 1.0;
    content.move_to(points_of(middle - 4.0), points_of(base + 1.0));
    content.line_to(points_of(middle + 4.0), points_of(base + 1.0));
    content.line_to(points_of(middle), points_of(tip));
    content.close_path().fill_nonzero();
    write(content, FORWARD_WORD, [middle + 6.0, base + 2.0]);
}

/// Draws a tag around its middle: a black square with white ones on it. If the black squares were drawn one by
/// one, printers and viewers might leave a seam where two of them touch.
fn draw_tag(content: &mut Content, id: usize, [x, y]: Point) {
    let square = edge(id) / SQUARES as f64;
    let half = edge(id) / 2.0;
    fill(content, [x - half, y - half], [edge(id); 2]);
    content.set_fill_gray(1.0);
    for row in 0..SQUARES {
        let mut column = 0;
        while column < SQUARES {
            let white_squares = (column..SQUARES).take_while(|&index| is_white(id, row, index));
            let run_length = white_squares.count();
            if run_length > 0 {
                let corner = [
                    x - half + column as f64 * square,
                    y + half - (row + 1) as f64 * square,
                ];
                fill(content, corner, [run_length as f64 * square, square]);
            }
            column += run_length.max(1);
        }
    }
    content.set_fill_gray(0.0);
}

fn fill(content: &mut Content, [x, y]: Point, [width, height]: Point) {
    content.rect(
        points_of(x),
        points_of(y),
        points_of(width),
        points_of(height),
    );
    content.fill_nonzero();
}

fn draw_cut_line(content: &mut Content, [x, y]: Point, [width, height]: Point) {
    content
        .set_line_width(points_of(CUT_THICKNESS))
        .set_stroke_gray(CUT_GREY);
    content.rect(
        points_of(x),
        points_of(y),
        points_of(width),
        points_of(height),
    );
    content.stroke();
}

fn write(content: &mut Content, text: &str, [x, y]: Point) {
    content.begin_text().set_font(FONT, points_of(FONT_SIZE));
    content.next_line(points_of(x), points_of(y));
    content.show(Str(text.as_bytes())).end_text();
}
