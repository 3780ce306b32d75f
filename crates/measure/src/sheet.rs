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
const TYPE: f64 = 3.3;
const LINE: f64 = 4.7;
/// Thickness of the cut lines, and of the ruler's lines, mm.
const CUT: f64 = 0.15;
const RULED: f64 = 0.3;
/// Grey of the cut lines.
const CUT_GREY: f32 = 0.6;

/// Instructions to print, cut, lay and glue the sheet, printed beside the card.
const WORDS: [&str; 9] = [
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
        let size = self.size().map(points);
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
        let mut only = pdf.page(page);
        only.media_box(Rect::new(0.0, 0.0, size[0], size[1]));
        only.parent(pages).contents(content);
        only.resources().fonts().pair(FONT, font);
        only.finish();
        pdf.type1_font(font).base_font(Name(b"Helvetica"));
        pdf.stream(content, &drawing(self).finish());
        pdf.finish()
    }
}

/// Converts mm to points.
fn points(mm: f64) -> f32 {
    (mm / POINT) as f32
}

/// Draws the whole page.
fn drawing(paper: Paper) -> Content {
    let mut content = Content::new();
    let [width, height] = paper.size();
    let left = (width - STRIP[0]) / 2.0;
    let used = STRIPS as f64 * STRIP[1] + CARD[1];
    let mut top = f64::midpoint(height, used);
    for strip in 0..STRIPS {
        draw_strip(&mut content, strip, [left, top - STRIP[1]]);
        top -= STRIP[1];
    }
    draw_card(&mut content, [left, top - CARD[1]]);
    let words = [left + CARD[0] + 8.0, top - 8.0];
    for (i, line) in WORDS.iter().enumerate() {
        write(&mut content, line, [words[0], words[1] - i as f64 * LINE]);
    }
    content
}

/// Draws a strip with its lower left corner at a point.
fn draw_strip(content: &mut Content, strip: usize, [x, y]: Point) {
    cut_line(content, [x, y], STRIP);
    let middle = [x + STRIP[0] / 2.0, y + STRIP[1] / 2.0];
    for id in strip * TAGS_ON_STRIP..(strip + 1) * TAGS_ON_STRIP {
        let [u, v] = middle_on_strip(id);
        draw_tag(content, id, [middle[0] + u, middle[1] + v]);
    }
    let begin = middle[0] - RULER / 2.0;
    fill(content, [begin, middle[1] - RULED / 2.0], [RULER, RULED]);
    for i in 0..=10 {
        // The outer edges of the first and the last mark are the ends of the ruler.
        let at = begin + f64::from(i) * (RULER - RULED) / 10.0;
        let long = if i % 10 == 0 { 8.0 } else { 3.0 };
        fill(content, [at, middle[1] - long / 2.0], [RULED, long]);
    }
    let words = format!(
        "strip {} of {STRIPS}: flat on the floor, beside the robot's way",
        strip + 1
    );
    write(content, &words, [begin, middle[1] + 8.0]);
    let words = "from end to end: 100 mm";
    write(content, words, [begin, middle[1] - 10.0]);
}

/// Draws the deck's card with its lower left corner at a point.
fn draw_card(content: &mut Content, [x, y]: Point) {
    cut_line(content, [x, y], CARD);
    let middle = x + CARD[0] / 2.0;
    draw_tag(
        content,
        DECK_TAG,
        [middle, y + CARD_MARGIN + DECK_EDGE / 2.0],
    );
    // The arrow begins beyond the white margin of the tag.
    let base = y + CARD_MARGIN + DECK_EDGE + CARD_MARGIN;
    let tip = y + CARD[1] - 1.0;
    content.move_to(points(middle - 4.0), points(base + 1.0));
    content.line_to(points(middle + 4.0), points(base + 1.0));
    content.line_to(points(middle), points(tip));
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
            let white = (column..SQUARES).take_while(|&at| is_white(id, row, at));
            let run = white.count();
            if run > 0 {
                let corner = [
                    x - half + column as f64 * square,
                    y + half - (row + 1) as f64 * square,
                ];
                fill(content, corner, [run as f64 * square, square]);
            }
            column += run.max(1);
        }
    }
    content.set_fill_gray(0.0);
}

fn fill(content: &mut Content, [x, y]: Point, [width, height]: Point) {
    content.rect(points(x), points(y), points(width), points(height));
    content.fill_nonzero();
}

fn cut_line(content: &mut Content, [x, y]: Point, [width, height]: Point) {
    content
        .set_line_width(points(CUT))
        .set_stroke_gray(CUT_GREY);
    content.rect(points(x), points(y), points(width), points(height));
    content.stroke();
}

fn write(content: &mut Content, words: &str, [x, y]: Point) {
    content.begin_text().set_font(FONT, points(TYPE));
    content.next_line(points(x), points(y));
    content.show(Str(words.as_bytes())).end_text();
}
