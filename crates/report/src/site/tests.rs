use super::*;

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("hasard-site-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn files_below(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        if entry.path().is_dir() {
            files_below(&entry.path(), all);
        } else {
            all.push(entry.path());
        }
    }
}

/// What a page names in an attribute.
fn named<'a>(html: &'a str, attribute: &str) -> Vec<&'a str> {
    let begin = format!(" {attribute}=\"");
    html.split(&begin).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// The site of this repository: every link leads to a file and an anchor that are there, and
/// nothing is fetched from elsewhere.
#[test]
fn the_site_of_this_repository_is_whole() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let out = folder("whole");
    let film = out.join("more.mp4");
    std::fs::write(&film, b"a film").unwrap();
    let site = out.join("site");
    let written =
        write_site(&Sources { root, films: vec![film] }, &site).expect("the site is written");
    assert!(written.pages > 50, "{written:?}");
    assert!(written.lost.is_empty(), "{:?}", written.lost);
    let mut files = Vec::new();
    files_below(&site, &mut files);
    let mut links = 0;
    for path in files.iter().filter(|path| path.extension().is_some_and(|it| it == "html")) {
        // The scoreboard is a page of its own making.
        let own = !path.to_string_lossy().contains("scoreboard/");
        let html = std::fs::read_to_string(path).unwrap();
        for source in named(&html, "src") {
            assert!(!source.contains("//"), "{}: fetches {source}", path.display());
        }
        assert!(!html.contains("<script src") && !html.contains("@import"), "{}", path.display());
        for target in named(&html, "href").into_iter().chain(named(&html, "src")) {
            if target.contains("://") || target.starts_with("data:") || target.starts_with("mailto")
            {
                continue;
            }
            links += 1;
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let place =
                if file.is_empty() { path.clone() } else { path.parent().unwrap().join(file) };
            assert!(place.is_file(), "{}: {target} leads nowhere", path.display());
            if own && !anchor.is_empty() {
                let there = std::fs::read_to_string(&place).unwrap();
                let id = format!("id=\"{anchor}\"");
                assert!(there.contains(&id), "{}: {target} has no such place", path.display());
            }
        }
    }
    assert!(links > 500, "{links}");
    let films = std::fs::read_to_string(site.join("films/index.html")).unwrap();
    assert!(films.contains("more.mp4") && films.contains("remedy_rush.gif"));
    std::fs::remove_dir_all(out).unwrap();
}

#[test]
fn what_is_not_there_is_left_out_and_nothing_comes_from_elsewhere() {
    let root = folder("small");
    std::fs::create_dir_all(root.join("docs")).unwrap();
    std::fs::write(root.join("docs/SUMMARY.md"), "# Summary\n\n- [One](one.md)\n").unwrap();
    std::fs::write(root.join("docs/one.md"), "# One & `two`\n\n## A, b!\n\n## A, b!\n").unwrap();
    let face = "# Face\n\n[a](docs/one.md#a-b) [gone](gone.md) [two](two%20words.md) ![badge](https://example.org/b.svg) [out](../../etc/passwd)\n";
    std::fs::write(root.join("README.md"), face).unwrap();
    std::fs::write(root.join("two words.md"), "# Two words\n").unwrap();
    let film = root.join("best #1 100%.gif");
    std::fs::write(&film, b"a film").unwrap();
    let out = root.join("site");
    let films = vec![film];
    let written = write_site(&Sources { root: root.clone(), films: films.clone() }, &out).unwrap();
    let page = std::fs::read_to_string(out.join("films/index.html")).unwrap();
    assert!(page.contains("src=\"best%20%231%20100%25.gif\""), "{page}");
    assert!(out.join("two words.html").is_file() && out.join("films/best #1 100%.gif").is_file());
    let twice = Sources { root: root.clone(), films: [films.clone(), films].concat() };
    let error = write_site(&twice, &root.join("twice")).unwrap_err();
    assert!(error.contains("best #1 100%.gif: a film of this name is there already"), "{error}");
    assert_eq!(written.lost, ["README.md: ../../etc/passwd", "README.md: gone.md"]);
    let html = std::fs::read_to_string(out.join("index.html")).unwrap();
    assert!(html.contains("href=\"docs/one.html#a-b\"") && !html.contains("example.org"), "{html}");
    assert!(html.contains("gone") && !html.contains("gone.md"));
    let one = std::fs::read_to_string(out.join("docs/one.html")).unwrap();
    assert!(one.contains("<title>One &amp; two</title>") && one.contains("id=\"a-b-1\""), "{one}");
    let error = write_site(&Sources { root: out, films: Vec::new() }, &root.join("x")).unwrap_err();
    assert!(error.contains("--root"), "{error}");
    std::fs::remove_dir_all(root).unwrap();
}
