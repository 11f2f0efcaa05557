//! The book and the documents of the repository: every page is in the summary, and every link leads somewhere.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the Markdown files of a folder and its subfolders.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(pages(&path));
        } else if path.extension().is_some_and(|ending| ending == "md") {
            found.push(path);
        }
    }
    found
}

/// Returns the text without blocks and spans of code, in which brackets are no links.
fn prose(text: &str) -> String {
    let mut is_code = false;
    let mut kept = String::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
            continue;
        }
        if is_code {
            continue;
        }
        for (k, part) in line.split('`').enumerate() {
            if k % 2 == 0 {
                kept.push_str(part);
            }
        }
        kept.push('\n');
    }
    kept
}

/// Returns the targets of links and pictures.
fn links(text: &str) -> Vec<String> {
    let prose = prose(text);
    let parts = prose.split("](").skip(1);
    let targets = parts.filter_map(|part| Some(part.split_once(')')?.0.trim().to_owned()));
    targets.collect()
}

/// Returns the anchors of a page: those of the headings, as mdBook and repository viewers form them, and explicit ones.
fn anchors(text: &str) -> BTreeSet<String> {
    let is_kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
    let explicit = text.split("id=\"").skip(1);
    let explicit = explicit.filter_map(|part| Some(part.split_once('"')?.0.to_owned()));
    let headings = text.lines().filter(|line| line.starts_with('#'));
    headings
        .map(|line| {
            let title = line.trim_start_matches('#').trim().to_lowercase();
            title
                .chars()
                .filter(is_kept)
                .collect::<String>()
                .replace(' ', "-")
        })
        .chain(explicit)
        .collect()
}

#[test]
fn all_pages_of_the_book_are_in_the_summary() {
    let source = root().join("book/src");
    let summary = source.join("SUMMARY.md");
    let listed: BTreeSet<PathBuf> = links(&fs::read_to_string(&summary).unwrap())
        .iter()
        .map(|link| source.join(link))
        .collect();
    let written: BTreeSet<PathBuf> = pages(&source)
        .into_iter()
        .filter(|page| *page != summary)
        .collect();
    assert_eq!(listed, written);
}

#[test]
fn links_of_documents_lead_to_files_and_headings() {
    let root = root();
    let mut documents = pages(&root.join("book/src"));
    for folder in ["", "benches", "examples", "validation", "crates"] {
        let found = fs::read_dir(root.join(folder)).unwrap();
        let paths = found.map(|entry| entry.unwrap().path());
        for path in paths {
            if path.extension().is_some_and(|ending| ending == "md") {
                documents.push(path);
            } else if path.is_dir() && path.join("README.md").exists() {
                documents.push(path.join("README.md"));
            }
        }
    }
    let mut broken = Vec::new();
    for document in &documents {
        let text = fs::read_to_string(document).unwrap();
        for link in links(&text) {
            if link.contains("://") || link.starts_with("mailto:") {
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = match file {
                "" => document.clone(),
                file => document.parent().unwrap().join(file),
            };
            let is_page = target.extension().is_some_and(|ending| ending == "md");
            let leads = target.exists()
                && (anchor.is_empty()
                    || !is_page
                    || anchors(&fs::read_to_string(&target).unwrap()).contains(anchor));
            if !leads {
                broken.push(format!("{}: {link}", document.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}
