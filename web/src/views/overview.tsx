// SPDX-License-Identifier: MIT
import { useEffect } from "preact/hooks";
import { alarmFeed, linkFeed, vehicleFeed } from "../model/observed";
import { Alarms } from "./alarms";
import { Hops } from "./hops";
import { Vehicles } from "./vehicles";

export function Overview() {
    useEffect(() => {
        const ends = [vehicleFeed.use(), linkFeed.use(), alarmFeed.use()];
        return () => ends.forEach((end) => end());
    }, []);
    return (
        <>
            <Vehicles />
            <Hops />
            <Alarms />
        </>
    );
}
