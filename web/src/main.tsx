// SPDX-License-Identifier: MIT
import { render } from "preact";
import "uplot/dist/uPlot.min.css";
import "./style/base.css";
import "./style/views.css";
import "./style/plots.css";
import { App } from "./app";
import { followOpened } from "./model/latest";
import { record } from "./model/recorders";
import { keepAddress } from "./model/state";
import { takeKey } from "./ui/keys";
import { connect, watch } from "./wire/connection";

keepAddress();
followOpened();
record();
connect();
watch();
addEventListener("keydown", takeKey);
const root = document.getElementById("app");
if (root) render(<App />, root);
