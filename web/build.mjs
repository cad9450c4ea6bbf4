// SPDX-License-Identifier: MIT
// node build.mjs: bundles src/ into dist/, with the licences of the packages that the bundle contains.
// node build.mjs --test: bundles test/*.test.ts into tests/, for `node --test`.
import { build } from "esbuild";
import { copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";

const common = { bundle: true, jsx: "automatic", jsxImportSource: "preact", logLevel: "warning" };

async function page() {
    const done = await build({
        ...common,
        entryPoints: { app: "src/main.tsx" },
        outdir: "dist",
        target: ["es2022"],
        minify: true,
        legalComments: "none",
        charset: "ascii",
        lineLimit: 120,
        metafile: true,
    });
    copyFileSync("src/index.html", "dist/index.html");
    writeFileSync("dist/licences.txt", licences(Object.keys(done.metafile.inputs)));
}

function licences(inputs) {
    const names = inputs.flatMap((path) => path.match(/node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1] ?? []);
    const texts = [...new Set(names)].sort().map((name) => {
        const folder = `node_modules/${name}`;
        const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
        const { version } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
        return `${name} ${version}\n\n${readFileSync(`${folder}/${file}`, "utf8").trim()}\n`;
    });
    return `The page of Mavloom contains these packages.\n\n${texts.join("\n----\n\n")}`;
}

async function tests() {
    mkdirSync("tests", { recursive: true });
    const entryPoints = readdirSync("test")
        .filter((name) => name.endsWith(".test.ts"))
        .map((name) => `test/${name}`);
    await build({
        ...common,
        entryPoints,
        outdir: "tests",
        platform: "node",
        format: "esm",
        outExtension: { ".js": ".mjs" },
    });
}

mkdirSync("dist", { recursive: true });
await (process.argv.includes("--test") ? tests() : page());
