//! A page of Markdown as HTML.

use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};
use std::collections::BTreeMap;

/// Where links lead in the site.
pub(super) trait Links {
    /// The address of a link that leads to a file of the clone; `None` if there is none: its words
    /// stay.
    fn link(&mut self, target: &str) -> Option<String>;
}

/// A page.
pub(super) struct Rendered {
    /// Words of its first heading.
    pub title: Option<String>,
    pub body: String,
}

/// Renders a page. Pictures from elsewhere become links: the site fetches nothing.
pub(super) fn render(markdown: &str, links: &mut impl Links) -> Rendered {
    let options = Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH;
    let events: Vec<Event<'_>> = Parser::new_ext(markdown, options).collect();
    let anchors = anchors(&events);
    let mut headings = anchors.iter();
    // Of links and pictures that are open: what closes them.
    let mut open: Vec<Option<Event<'_>>> = Vec::new();
    let mut done = Vec::with_capacity(events.len());
    for event in events {
        match event {
            Event::Start(Tag::Heading { level, classes, attrs, .. }) => {
                let id = headings.next().map(|(id, _)| CowStr::from(id.clone()));
                done.push(Event::Start(Tag::Heading { level, id, classes, attrs }));
            }
            Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
                let to = if is_elsewhere(&dest_url) || dest_url.starts_with('#') {
                    Some(dest_url.to_string())
                } else {
                    links.link(&dest_url)
                };
                open.push(to.as_ref().map(|_| Event::End(TagEnd::Link)));
                if let Some(to) = to {
                    let dest_url = CowStr::from(to);
                    done.push(Event::Start(Tag::Link { link_type, dest_url, title, id }));
                }
            }
            Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
                if is_elsewhere(&dest_url) {
                    open.push(None);
                } else if let Some(to) = links.link(&dest_url) {
                    open.push(Some(Event::End(TagEnd::Image)));
                    let dest_url = CowStr::from(to);
                    done.push(Event::Start(Tag::Image { link_type, dest_url, title, id }));
                } else {
                    open.push(None);
                }
            }
            Event::End(TagEnd::Link | TagEnd::Image) => done.extend(open.pop().flatten()),
            other => done.push(other),
        }
    }
    let mut body = String::new();
    html::push_html(&mut body, done.into_iter());
    // Wide tables scroll within themselves.
    let body = body
        .replace("<table>", "<div class=\"wide\"><table>")
        .replace("</table>", "</table></div>");
    Rendered { title: anchors.into_iter().next().map(|(_, words)| words), body }
}

fn is_elsewhere(target: &str) -> bool {
    ["http://", "https://", "mailto:"].iter().any(|start| target.starts_with(start))
}

/// Anchor and words of each heading, the anchors as GitHub and mdBook make them.
fn anchors(events: &[Event<'_>]) -> Vec<(String, String)> {
    let mut all = Vec::new();
    let mut used: BTreeMap<String, usize> = BTreeMap::new();
    let mut words: Option<String> = None;
    for event in events {
        match event {
            Event::Start(Tag::Heading { level: HeadingLevel::H1, .. } | Tag::Heading { .. }) => {
                words = Some(String::new());
            }
            Event::End(TagEnd::Heading(_)) => {
                let title = words.take().unwrap_or_default();
                let name = anchor(&title);
                let times = used.entry(name.clone()).or_insert(0);
                let unique = if *times == 0 { name } else { format!("{name}-{times}") };
                *times += 1;
                all.push((unique, title));
            }
            Event::Text(text) | Event::Code(text) => {
                if let Some(words) = &mut words {
                    words.push_str(text);
                }
            }
            _ => {}
        }
    }
    all
}

fn anchor(title: &str) -> String {
    let letters = title.trim().chars().flat_map(char::to_lowercase);
    letters
        .filter(|letter| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_'))
        .map(|letter| if letter == ' ' { '-' } else { letter })
        .collect()
}
