//! The guide as an HTML page.

use std::fmt::Write;

/// Wraps the text between each pair of equal Markdown marks, such as `**`, in an HTML element, and drops the marks. The
/// marks must come in pairs: text after an unpaired one is dropped.
fn wrap_marked_text(text: &str, mark: &str, tag: &str) -> String {
    let mut parts = text.split(mark);
    let mut result = parts.next().unwrap_or_default().to_owned();
    while let (Some(inside), Some(rest)) = (parts.next(), parts.next()) {
        let _ = write!(result, "<{tag}>{inside}</{tag}>{rest}");
    }
    result
}

/// Converts the guide's Markdown to an HTML page. Supports only headings, pictures, tables, code, bold text and
/// paragraphs.
pub fn markdown_to_html(markdown: &str) -> String {
    let format_inline = |text: &str| {
        let text = text.replace('&', "&amp;").replace('<', "&lt;");
        wrap_marked_text(&wrap_marked_text(&text, "`", "code"), "**", "b")
    };
    let mut page = String::from(
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>Building the robot</title>\n<style>body{font:16px/1.5 sans-serif;max-width:46rem;margin:2rem auto;padding:0 1rem}\
         img{max-width:100%}td,th{padding:.1rem .7rem;border-bottom:1px solid #ddd;text-align:left}\
         pre{background:#f4f4f4;padding:.6rem}</style>\n",
    );
    let (mut is_in_table, mut is_in_code) = (false, false);
    for line in markdown.lines() {
        if line.starts_with("```") {
            page.push_str(if is_in_code { "</pre>\n" } else { "<pre>" });
            is_in_code = !is_in_code;
        } else if is_in_code {
            let _ = writeln!(page, "{}", format_inline(line));
        } else if let Some(cells) = line.strip_prefix('|') {
            if cells.starts_with("---") {
                continue;
            }
            let cell_tag = if is_in_table { "td" } else { "th" };
            page.push_str(if is_in_table { "<tr>" } else { "<table>\n<tr>" });
            is_in_table = true;
            for text in cells.trim_end_matches('|').split('|') {
                let _ = write!(
                    page,
                    "<{cell_tag}>{}</{cell_tag}>",
                    format_inline(text.trim())
                );
            }
            page.push_str("</tr>\n");
        } else {
            if is_in_table {
                page.push_str("</table>\n");
                is_in_table = false;
            }
            if let Some(title) = line.strip_prefix("## ") {
                let _ = writeln!(page, "<h2>{}</h2>", format_inline(title));
            } else if let Some(title) = line.strip_prefix("# ") {
                let _ = writeln!(page, "<h1>{}</h1>", format_inline(title));
            } else if let Some((alt_text, source)) = line
                .strip_prefix("![")
                .and_then(|rest| rest.strip_suffix(')'))
                .and_then(|rest| rest.split_once("]("))
            {
                let alt_text = format_inline(alt_text);
                let _ = writeln!(page, "<p><img src=\"{source}\" alt=\"{alt_text}\"></p>");
            } else if !line.is_empty() {
                let _ = writeln!(page, "<p>{}</p>", format_inline(line));
            }
        }
    }
    page.push_str("</html>\n");
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_headings_tables_code_and_pictures() {
        let page = markdown_to_html(
            "# A\n\n| a | b |\n|---|---|\n| 1 | x < y |\n\n![p](q.svg)\nrun `z`\n```toml\nk = 1\n```\n",
        );
        for fragment in [
            "<h1>A</h1>",
            "<tr><th>a</th><th>b</th></tr>",
            "<td>x &lt; y</td>",
            "</table>",
            "<img src=\"q.svg\" alt=\"p\">",
            "<p>run <code>z</code></p>",
            "<pre>k = 1\n</pre>",
        ] {
            assert!(page.contains(fragment), "{fragment} is missing in {page}");
        }
    }
}
