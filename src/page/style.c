#include "page/style.h"

#include "page/palette.h"

/* One typeface with the widths that the figures reckon with; lines of 75 characters; the column of figures is 720 px. */
static const char layout[] =
    "*{box-sizing:border-box}\n"
    "html{background:var(--paper);color:var(--ink);font:16px/1.5 Arial,\"Liberation Sans\",Helvetica,sans-serif;"
    "-webkit-text-size-adjust:100%;text-size-adjust:100%}\n"
    "body{margin:0 auto;padding:1.5rem 1rem 3rem;max-width:47rem;overflow-wrap:anywhere}\n"
    "h1{font-size:1.6rem;line-height:1.25;margin:0 0 .25rem;overflow-wrap:anywhere}\n"
    "h2{font-size:1.25rem;line-height:1.3;margin:2.75rem 0 .75rem;padding-top:.75rem;border-top:1px solid var(--grid)}\n"
    "h3{font-size:1rem;margin:1.5rem 0 .5rem}\n"
    "p,ul,dl{margin:.6rem 0}\nul{padding-left:1.25rem}\nli{margin:.3rem 0}\n"
    "a{color:var(--blue)}\n"
    ".subtitle{color:var(--muted);margin:0;overflow-wrap:anywhere}\n"
    ".answer{margin:1.25rem 0;padding:.9rem 1.1rem;background:var(--band);border-left:6px solid var(--tone);border-radius:2px}\n"
    ".answer p{margin:0}\n.answer .tone{font-weight:bold;color:var(--tone);margin-bottom:.25rem}\n.answer "
    ".says{font-size:1.1rem}\n.answer .of{font-size:.875rem;color:var(--muted);overflow-wrap:anywhere}\n"
    ".answer .next{margin-top:.5rem}\n"
    ".plain{--tone:var(--blue)}\n.good{--tone:var(--green)}\n.care{--tone:var(--ochre)}\n.bad{--tone:var(--vermilion)}\n"
    ".hint{border:1px solid var(--ochre);padding:.1rem 1rem;margin:1rem 0}\n"
    "nav ul{list-style:none;padding:0;display:flex;flex-wrap:wrap;gap:.25rem 1.25rem}\nnav li{margin:0}\n"
    "dl div{display:grid;grid-template-columns:11rem 1fr;gap:1rem;padding:.25rem 0;border-bottom:1px solid var(--grid)}\n"
    "dt{color:var(--muted)}\ndd{margin:0;overflow-wrap:anywhere}\n"
    ".set{margin:2rem 0}\nfigure{margin:0}\nfigure h3{margin:0 0 .5rem}\nfigcaption{margin:.4rem 0}\n"
    "figure img{width:100%;height:auto}\n.wide{display:block}\n.narrow{display:none}\n"
    ".files,details{font-size:.875rem;color:var(--muted);margin:.3rem 0}\nsummary{cursor:pointer}\n"
    ".scroll{overflow-x:auto;margin:.75rem 0}\n"
    "table{overflow-wrap:normal;border-collapse:collapse;font-size:.875rem;font-variant-numeric:tabular-nums;color:var(--ink)}\n"
    "caption{text-align:left;color:var(--muted);padding:.25rem 0}\n"
    "caption span{display:inline-block;position:sticky;left:0;max-width:min(45rem,calc(100vw - 2rem))}\n"
    "th,td{text-align:left;vertical-align:baseline;padding:.25rem .75rem .25rem 0;border-bottom:1px solid var(--grid);"
    "white-space:nowrap}\n"
    "thead th{border-bottom:1px solid var(--muted);white-space:normal;vertical-align:bottom}\ntbody th{font-weight:normal}\n"
    "td:last-child{white-space:normal;min-width:5rem;padding-right:0}\n.n{text-align:right}\n"
    "footer{margin-top:3rem;padding-top:.75rem;border-top:1px solid var(--grid);font-size:.875rem;color:var(--muted);"
    "overflow-wrap:anywhere}\n"
    "@media (max-width:600px){td:last-child:not(.n){min-width:11rem}.wide{display:none}.narrow{display:block}body{padding:1rem "
    "1rem 2rem}h1{font-size:1.35rem}"
    "dl div{grid-template-columns:1fr;gap:0}}\n";

static const char paper[] =
    "@page{margin:15mm}\nbody{max-width:none;padding:0}\nhtml{font-size:10pt}\nfigure{margin:1rem "
    "0}\nh2{margin-top:1.5rem}\nnav,details,.files{display:none}\n.wide{display:block}\n"
    ".narrow{display:none}\nfigure,table,.answer,li,dl div{break-inside:avoid}\nh2,h3,caption{break-after:avoid}\n"
    ".scroll{overflow:visible}\ntable{overflow-wrap:anywhere}\ntd,tbody th{white-space:normal}\nthead{display:table-header-group}\na{color:inherit;text-decoration:none}\n"
    ".answer{background:none;border:1px solid var(--ink);border-left:6px solid var(--ink)}\n.answer .tone{color:var(--ink)}\n";

void style_write(FILE *out)
{
    (void)fputs(":root{", out);
    palette_style(out, 0);
    (void)fputs("}\n@media screen and (prefers-color-scheme:dark){:root{", out);
    palette_style(out, 1);
    (void)fputs("}}\n", out);
    (void)fputs(layout, out);
    (void)fprintf(out, "@media print{\n%s}\n", paper);
}
